// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/unwritten.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "common/message_text.h"
#include "tetwright/io.h"
#include "tetwright/sheets.h"

namespace tetwright {

namespace {

/// Name of an output file in notes.
std::string shown(const std::string& file) { return file == "-" ? "standard output" : file; }

/// Adds a note about numbers and names that are changed in `file`.
void note_changes(const std::string& file, const std::string& extension, const char* what,
                  const std::vector<NameChange>& changed, PrepareReport& report) {
  if (changed.empty()) return;
  const NameChange& first = changed.front();
  report.diagnostics.push_back({.code = DiagnosticCode::names_changed,
                                .file = file,
                                .what = what,
                                .count = changed.size(),
                                .done = "changed, as " + extension + " cannot hold " +
                                        (changed.size() > 1 ? "them, the first: " : "it: ") + first.own +
                                        " -> " + first.written});
}

void note_missing(const std::string& file, const std::string& what, std::size_t count, const std::string& why,
                  PrepareReport& report) {
  if (count > 0)
    report.diagnostics.push_back({.code = DiagnosticCode::not_written,
                                  .file = file,
                                  .what = what,
                                  .count = count,
                                  .done = "not written" + why});
}

void find_name_changes(const CommandLine& line, const TetMesh& mesh, PrepareReport& report) {
  const OutputOptions& out = line.outputs;
  const NameChanges changes = written_name_changes(mesh, out.mesh, out.format, out.parts);
  const std::string extension = written_tet_format(out.mesh, out.format, out.parts).extension;
  const auto note = [&](const char* what, const std::vector<NameChange>& changed) {
    note_changes(shown(line.outputs.mesh), extension, what, changed, report);
  };
  note("tags of materials", changes.tags);
  note("names of materials", changes.material_names);
  note("names of fields", changes.fields);
  if (line.outputs.no_boundary) return;
  note("numbers of patches", changes.patch_numbers);
  note("names of patches", changes.patch_names);
}

std::size_t named_caps(const PrepareReport& report) {
  if (!report.caps) return 0;
  return static_cast<std::size_t>(std::count_if(report.caps->caps.begin(), report.caps->caps.end(),
                                                [](const CapReport::Cap& cap) { return cap.named; }));
}

/// Selections with faces.
std::size_t named_selections(const PrepareReport& report) {
  return static_cast<std::size_t>(
      std::count_if(report.selected.begin(), report.selected.end(),
                    [](const SelectedFaces& selected) { return selected.faces > 0; }));
}

/// Patches of the input, without those that became the sides of parted interfaces.
std::size_t input_patches(const PrepareReport& report) {
  std::size_t count = report.patches.size();
  for (const PartedInterface& parted : report.parted) count -= std::min(count, parted.renamed_groups.size());
  return count;
}

std::size_t named_patches(const PrepareReport& report) {
  return named_caps(report) + named_selections(report) +
         static_cast<std::size_t>(
             std::count_if(report.patches.begin(), report.patches.end(),
                           [](const PatchComparison& p) { return !p.group.name.empty(); }));
}

/// Number of patches that are sheets, which every format of tet meshes can hold.
std::size_t sheet_patches(const PrepareReport& report, const TetMesh& mesh) {
  std::set<SurfaceRegion> of_sheets;
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (t.is_sheet())
      if (const auto group = mesh.patch_groups.find({t.pair(), t.patch}); group != mesh.patch_groups.end())
        of_sheets.insert(group->second);
  return static_cast<std::size_t>(
      std::count_if(report.patches.begin(), report.patches.end(),
                    [&](const PatchComparison& p) { return of_sheets.contains(p.group); }));
}

/// Adds a note about patches that neither the mesh file nor the --boundary file can hold.
void find_unwritten_patches(const CommandLine& line, const TetFormatInfo& format, const TetMesh& mesh,
                            PrepareReport& report) {
  const bool boundary_lacks =
      !line.outputs.boundary.empty() &&
      !written_surface_format(line.outputs.boundary, line.outputs.boundary_format).names;
  if (!line.outputs.boundary.empty() && !boundary_lacks) return;
  const auto note = [&](const char* what, std::size_t count, const std::string& why) {
    note_missing(shown(line.outputs.mesh), what, count, why, report);
  };
  const std::string no_place =
      "; " + format.extension + " cannot hold them, " +
      (boundary_lacks ? "nor can .off, but .vtp .ply .stl .obj can" : "but --boundary FILE can") +
      ", and .msh";
  if (line.outputs.no_boundary)
    note("named patches", input_patches(report) + named_caps(report) + named_selections(report),
         ", as --no-boundary asks");
  else if (!format.surfaces)
    note("named patches",
         input_patches(report) + named_caps(report) + named_selections(report) - sheet_patches(report, mesh),
         no_place);
  else if (!format.patch_names)
    note("names of patches", named_patches(report), no_place);
}

void find_boundary_changes(const CommandLine& line, const TetMesh& mesh, PrepareReport& report) {
  if (line.outputs.boundary.empty()) return;
  note_changes(shown(line.outputs.boundary),
               written_surface_format(line.outputs.boundary, line.outputs.boundary_format).extension,
               "names of patches",
               written_interface_name_changes(mesh, line.outputs.boundary, line.outputs.boundary_format),
               report);
}

/// Adds a note about faces inside the mesh, if the format holds its outside alone and no other file has them.
void find_unwritten_inner_faces(const CommandLine& line, const TetFormatInfo& format, const TetMesh& mesh,
                                PrepareReport& report) {
  if (format.inner_surfaces || line.outputs.no_boundary || !line.outputs.boundary.empty()) return;
  const auto inside = std::count_if(mesh.interfaces.begin(), mesh.interfaces.end(),
                                    [](const InterfaceTriangle& t) { return t.other.has_value(); });
  note_missing(shown(line.outputs.mesh), "faces between materials and of sheets",
               static_cast<std::size_t>(inside),
               "; " + format.extension + " cannot hold them, but --boundary FILE can", report);
}

/// Adds a shortfall if the format rounds coordinates and tets do not survive that.
void find_rounded_tets(const CommandLine& line, const TetFormatInfo& format, const TetMesh& mesh,
                       PrepareReport& report) {
  if (!format.single_precision) return;
  const SinglePrecisionLoss loss = single_precision_loss(mesh);
  if (loss.tets == 0 && loss.points == 0) return;
  const bool tets = loss.tets > 0;
  std::string what =
      tets ? "tets are flat or negative in single precision, the first at " + place_text(loss.first)
           : "different points are equal to others in single precision";
  if (tets && loss.points > 0) what += "; " + std::to_string(loss.points) + " points are equal to others";
  report.diagnostics.push_back(
      {.code = DiagnosticCode::single_precision,
       .file = shown(line.outputs.mesh),
       .what = what,
       .count = tets ? loss.tets : loss.points,
       .remedy = "move the input to the origin, or write another format than " + format.extension,
       .places = tets ? std::vector<Vec3>{loss.first} : std::vector<Vec3>{}});
}

void find_unwritten_bins(const CommandLine& line, const TetFormatInfo& format, PrepareReport& report) {
  const bool in_parts = line.outputs.parts > 0;
  for (std::size_t d = 0; d < report.bins.size(); ++d) {
    const BinsReport& bins = report.bins[d];
    const auto note = [&](const std::string& what, const std::string& why) {
      note_missing(shown(line.outputs.mesh), what + (report.bins.size() > 1 ? " of " + bins.field : ""),
                   bins.bins.size(), why, report);
    };
    const std::string in_table = "; " + format.extension + " cannot hold them, but the table can";
    if (format.bins == BinsAs::none || in_parts) {
      if (!format.fields) note("sets of bins", in_table);
      if (format.bins != BinsAs::none) note("sets of bins", ", but their numbers are a field");
    } else if (format.bins == BinsAs::materials && d != leading_division(report.bins)) {
      note("sets of bins", "; an element is in one group, but their numbers are a field");
    }
    if (bins.poisson && (!format.moduli || in_parts)) note("elastic moduli of bins", in_table);
  }
}

}  // namespace

void find_unwritten(const CommandLine& line, const TetMesh& mesh, PrepareReport& report) {
  const TetFormatInfo format = written_tet_format(line.outputs.mesh, line.outputs.format, line.outputs.parts);
  const std::string no_place = "; " + format.extension + " cannot hold them";
  const auto note = [&](const std::string& what, std::size_t count, const std::string& why) {
    note_missing(shown(line.outputs.mesh), what, count, why, report);
  };
  find_unwritten_patches(line, format, mesh, report);
  if (line.outputs.no_boundary)
    note("names of the sides of parted interfaces, without which they cannot be joined again",
         2 * report.parted.size(), ", as --no-boundary asks");
  if (line.outputs.no_boundary) note("faces of sheets", sheets_of(mesh).size(), ", as --no-boundary asks");
  if (!format.names) note("names of materials", mesh.material_names.size(), no_place);
  if (!format.fields) note("fields", mesh.point_fields.size() + mesh.cell_fields.size(), no_place);
  find_unwritten_inner_faces(line, format, mesh, report);
  find_rounded_tets(line, format, mesh, report);
  if (line.outputs.mesh == "-") {
    std::size_t pairs = 0;
    for (const PartedInterface& parted : report.parted) pairs += parted.pairs.size();
    note("pairs of points on parted interfaces", pairs, "; their table needs a file name beside it");
  }
  find_unwritten_bins(line, format, report);
  if (!format.patch_names)
    note("names of the sides of parted interfaces", 2 * report.parted.size(), no_place);
  if (!format.wedges || line.outputs.parts > 0) note("cohesive elements", mesh.wedges.size(), no_place);
  find_name_changes(line, mesh, report);
  find_boundary_changes(line, mesh, report);
}

}  // namespace tetwright

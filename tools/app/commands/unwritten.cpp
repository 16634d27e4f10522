// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/unwritten.h"

#include <algorithm>
#include <string>
#include <vector>

#include "common/io/formats.h"

namespace tetwright {

namespace {

/// What notes call a file that is written.
std::string shown(const std::string& file) { return file == "-" ? "standard output" : file; }

/// Notes what `file` has in place of numbers and names of the user's.
void note_changes(const std::string& file, const std::string& extension, const char* what,
                  const std::vector<NameChange>& changed, RunReport& report) {
  if (changed.empty()) return;
  const NameChange& first = changed.front();
  report.findings.push_back(
      {file,
       {what,
        changed.size(),
        {},
        "changed, as " + extension + " cannot hold " + (changed.size() > 1 ? "them, the first: " : "it: ") +
            first.own + " -> " + first.written}});
}

void note_missing(const std::string& file, const std::string& what, std::size_t count, const std::string& why,
                  RunReport& report) {
  if (count > 0) report.findings.push_back({file, {what, count, {}, "not written" + why}});
}

void find_name_changes(const CommandLine& line, const TetMesh& mesh, RunReport& report) {
  const NameChanges changes = written_name_changes(mesh, line.output, line.output_format);
  const std::string extension = written_tet_format(line.output, line.output_format).extension;
  const auto note = [&](const char* what, const std::vector<NameChange>& changed) {
    note_changes(shown(line.output), extension, what, changed, report);
  };
  note("tags of materials", changes.tags);
  note("names of materials", changes.material_names);
  note("names of fields", changes.fields);
  if (line.no_boundary) return;
  note("numbers of patches", changes.patch_numbers);
  note("names of patches", changes.patch_names);
}

std::size_t named_patches(const RunReport& report) {
  return static_cast<std::size_t>(
      std::count_if(report.patches.begin(), report.patches.end(),
                    [](const PatchComparison& p) { return !p.group.name.empty(); }));
}

/// What neither the mesh nor --boundary tells of patches.
void find_unwritten_patches(const CommandLine& line, const TetFormatInfo& format, RunReport& report) {
  const bool boundary_lacks =
      !line.boundary.empty() && !written_surface_format(line.boundary, line.boundary_format).names;
  if (!line.boundary.empty() && !boundary_lacks) return;
  const auto note = [&](const char* what, std::size_t count, const std::string& why) {
    note_missing(shown(line.output), what, count, why, report);
  };
  const std::string no_place =
      "; " + format.extension + " has no place for them, " +
      (boundary_lacks ? "nor has .off, but .vtp .ply .stl .obj have" : "but --boundary FILE has") +
      ", and .msh";
  if (line.no_boundary)
    note("named patches", report.patches.size(), ", as --no-boundary asks");
  else if (!format.surfaces)
    note("named patches", report.patches.size(), no_place);
  else if (!format.patch_names)
    note("names of patches", named_patches(report), no_place);
}

void find_boundary_changes(const CommandLine& line, const TetMesh& mesh, RunReport& report) {
  if (line.boundary.empty()) return;
  note_changes(shown(line.boundary), written_surface_format(line.boundary, line.boundary_format).extension,
               "names of patches", written_interface_name_changes(mesh, line.boundary, line.boundary_format),
               report);
}

}  // namespace

void find_unwritten(const CommandLine& line, const TetMesh& mesh, RunReport& report) {
  const TetFormatInfo format = written_tet_format(line.output, line.output_format);
  const std::string no_place = "; " + format.extension + " has no place for them";
  const auto note = [&](const std::string& what, std::size_t count, const std::string& why) {
    note_missing(shown(line.output), what, count, why, report);
  };
  find_unwritten_patches(line, format, report);
  if (!format.names) note("names of materials", mesh.material_names.size(), no_place);
  if (!format.fields) note("fields", mesh.point_fields.size() + mesh.cell_fields.size(), no_place);
  find_name_changes(line, mesh, report);
  find_boundary_changes(line, mesh, report);
}

}  // namespace tetwright

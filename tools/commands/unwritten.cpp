#include "tools/commands/unwritten.h"

#include <algorithm>
#include <string>
#include <vector>

#include "common/formats/formats.h"

namespace tetwright {

namespace {

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
    note_changes(line.output, extension, what, changed, report);
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
                    [](const PatchFidelity& p) { return !p.group.name.empty(); }));
}

/// What --boundary lacks. Returns whether it tells patches apart.
bool find_unwritten_by_boundary(const CommandLine& line, const TetMesh& mesh, RunReport& report) {
  if (line.boundary.empty()) return false;
  const SurfaceFormatInfo format = written_surface_format(line.boundary, line.boundary_format);
  if (!format.names)
    note_missing(line.boundary, "named patches", report.patches.size(),
                 "; " + format.extension + " has no place for them, but .vtp .ply .stl .obj have", report);
  note_changes(line.boundary, format.extension, "names of patches",
               written_interface_name_changes(mesh, line.boundary, line.boundary_format), report);
  return format.names;
}

}  // namespace

void find_unwritten(const CommandLine& line, const TetMesh& mesh, RunReport& report) {
  const TetFormatInfo format = written_tet_format(line.output, line.output_format);
  const std::string no_place = "; " + format.extension + " has no place for them",
                    but_elsewhere = no_place + ", but --boundary FILE has, and .msh";
  const auto note = [&](const std::string& what, std::size_t count, const std::string& why) {
    note_missing(line.output, what, count, why, report);
  };
  if (!find_unwritten_by_boundary(line, mesh, report)) {
    if (line.no_boundary)
      note("named patches", report.patches.size(), ", as --no-boundary asks");
    else if (!format.surfaces)
      note("named patches", report.patches.size(), but_elsewhere);
    else if (!format.patch_names)
      note("names of patches", named_patches(report), but_elsewhere);
  }
  if (!format.names) note("names of materials", mesh.material_names.size(), no_place);
  if (!format.fields) note("fields", mesh.point_fields.size() + mesh.cell_fields.size(), no_place);
  find_name_changes(line, mesh, report);
}

}  // namespace tetwright

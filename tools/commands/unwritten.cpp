#include "tools/commands/unwritten.h"

#include <algorithm>
#include <string>
#include <vector>

#include "common/formats/formats.h"

namespace tetwright {

namespace {

/// What the format of the output cannot hold as it is.
void find_name_changes(const CommandLine& line, const TetMesh& mesh, RunReport& report) {
  const NameChanges changes = written_name_changes(mesh, line.output, line.output_format);
  const std::string extension = written_tet_format(line.output, line.output_format).extension;
  const auto note = [&](const char* what, const std::vector<NameChange>& changed) {
    if (changed.empty()) return;
    const NameChange& first = changed.front();
    report.findings.push_back(
        {line.output,
         {what,
          changed.size(),
          {},
          "changed, as " + extension + " cannot hold " + (changed.size() > 1 ? "them, the first: " : "it: ") +
              first.own + " -> " + first.written}});
  };
  note("tags of materials", changes.tags);
  note("names of materials", changes.material_names);
  if (line.no_boundary) return;
  note("numbers of patches", changes.patch_numbers);
  note("names of patches", changes.patch_names);
}

}  // namespace

void find_unwritten(const CommandLine& line, const TetMesh& mesh, RunReport& report) {
  const TetFormatInfo format = written_tet_format(line.output, line.output_format);
  const std::string no_place = "not written; " + format.extension + " has no place for them";
  const auto note = [&](const std::string& what, std::size_t count, const std::string& why) {
    if (count > 0) report.findings.push_back({line.output, {what, count, {}, why}});
  };
  if (line.boundary.empty() && line.no_boundary)
    note("named patches", report.patches.size(), "not written, as --no-boundary asks");
  else if (line.boundary.empty() && !format.surfaces)
    note("named patches", report.patches.size(), no_place + ", but --boundary FILE has, and .msh");
  else if (line.boundary.empty() && !format.patch_names)
    note(
        "names of patches",
        static_cast<std::size_t>(std::count_if(report.patches.begin(), report.patches.end(),
                                               [](const PatchFidelity& p) { return !p.group.name.empty(); })),
        no_place + ", but --boundary FILE has, and .msh");
  if (!format.names) note("names of materials", mesh.material_names.size(), no_place);
  if (!format.fields) note("fields", mesh.point_fields.size() + mesh.cell_fields.size(), no_place);
  find_name_changes(line, mesh, report);
}

}  // namespace tetwright

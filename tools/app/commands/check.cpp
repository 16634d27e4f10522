// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/files/atomic_file.h"
#include "common/io/formats.h"
#include "common/memory.h"
#include "common/mesh/interfaces.h"
#include "common/mesh/topology.h"
#include "tools/app/commands/command_run.h"
#include "tools/app/commands/commands.h"
#include "tools/app/commands/output_paths.h"
#include "tools/app/commands/report_file.h"
#include "tools/app/commands/scan_input.h"
#include "tools/app/commands/simplification.h"
#include "tools/app/printed_report.h"
#include "tools/report/stats_json.h"

namespace tetwright {

namespace {

/// Peak memory of the process: its libraries, and the mesh with its topology for each tet, of which a knot of
/// 116,000 takes 20 MB.
constexpr double program_bytes = 40e6;
constexpr double bytes_per_tet = 180;

/// Reads a mesh to be checked or compared with; `field_found` becomes true if it has --material-field.
TetMesh read_checked(const std::string& file, CommandRun& run, bool& field_found) {
  // Of two meshes one may have the field under the name `material`, if it was made from the other.
  ReadTetMesh read = take_tet_mesh(run, file, {run.line.material_field, run.line.before.empty()});
  field_found |= read.material_field == run.line.material_field;
  if (file == run.line.inputs.front()) run.report.material_field = read.material_field;
  report_dropped(read.dropped, file, run.report, !run.line.json);
  return std::move(read.mesh);
}

/// Checks and measures the mesh. Its topology is left out where its arrays are unsound.
CheckReport examine(TetMesh& mesh, CommandRun& run) {
  CheckReport check;
  check.findings = check_mesh(mesh);
  for (const MeshFinding& f : check.findings) check.measurable &= f.fault > MeshFault::coordinates_not_finite;
  if (!check.measurable) return check;
  mesh.interfaces = find_interfaces(mesh);
  run.report.result = mesh_statistics(mesh, run.line.min_solid_angle);
  run.report.material_names = mesh.material_names;
  return check;
}

/// The surfaces of --surface, by file.
void read_surfaces(CommandRun& run, std::vector<TriangleMesh>& surfaces, std::vector<std::string>& names) {
  for (const std::string& file : run.line.surfaces) {
    if (!is_object(run, file) && is_vdb(file)) {
      for (NamedSurface& s : read_level_sets(file)) {
        surfaces.push_back(std::move(s.surface));
        names.push_back(file);
      }
      continue;
    }
    std::vector<Dropped> dropped;
    surfaces.push_back(take_surface(run, file, &dropped));
    names.push_back(file);
    report_dropped(dropped, file, run.report, !run.line.json);
  }
}

TriangleMesh joined(const std::vector<TriangleMesh>& surfaces) {
  TriangleMesh all;
  for (const TriangleMesh& s : surfaces) {
    const auto first = static_cast<Index>(all.points.size());
    all.points.insert(all.points.end(), s.points.begin(), s.points.end());
    for (const Triangle& t : s.triangles) all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return all;
}

void compare_with_surfaces(TetMesh& mesh, CommandRun& run, CheckReport& check) {
  std::vector<TriangleMesh> surfaces;
  std::vector<std::string> names;
  read_surfaces(run, surfaces, names);
  check.surface = compare_with_surfaces(mesh, surfaces, names);
  measure_distances(mesh, joined(surfaces), "the surfaces", run);
  if (run.line.tolerance.value > 0) check.tolerance = tolerance_of(run.line, check.surface->diagonal);
}

const char* verdict(const CheckReport& check) {
  if (!check.valid()) return "not valid";
  if (!check.topology_kept()) return "valid, but of another topology";
  return check.within_tolerance() ? "valid" : "valid, but not within the tolerance";
}

void print_check(const CheckReport& check, const CommandRun& run) {
  for (const MeshFinding& f : check.findings)
    std::printf("%s: %s\n", is_warning(f.fault) ? "warning" : "error", mesh_finding_line(f).c_str());
  if (check.measurable) {
    print_report(run.line, run.report);
    for (const std::string& l : topology_lines(*check.topology)) std::printf("%s\n", l.c_str());
    if (check.surface)
      for (const std::string& l : comparison_lines(*check.surface)) std::printf("%s\n", l.c_str());
    if (check.tolerance > 0) std::printf("%s\n", tolerance_line(*check.surface, check.tolerance).c_str());
  }
  if (check.topology_differences)
    for (const std::string& d : *check.topology_differences) std::printf("topology differs: %s\n", d.c_str());
  std::printf("%s\n", verdict(check));
}

/// The errors and what falls short, to stderr: all that --quiet leaves.
void print_shortfalls(const CheckReport& check) {
  for (const MeshFinding& f : check.findings)
    if (!is_warning(f.fault)) print_line(mesh_finding_line(f));
  if (check.topology_differences)
    for (const std::string& d : *check.topology_differences) print_line("topology differs: " + d);
  if (!check.within_tolerance()) print_line(tolerance_line(*check.surface, check.tolerance));
}

}  // namespace

CheckReport make_check(CommandRun& run) {
  const CommandLine& line = run.line;
  check_output_paths(line);
  bool field_found = false;
  run.progress.begin_stage("read");
  TetMesh mesh = read_checked(line.inputs.front(), run, field_found);
  require_memory(program_bytes + bytes_per_tet * static_cast<double>(mesh.tets.size()),
                 line.inputs.front() + ": checking its " + std::to_string(mesh.tets.size()) + " tets",
                 "free some, or give a larger --memory-limit");
  run.progress.begin_stage("check");
  run.report.input_points = mesh.points.size();
  run.report.seconds_read = run.since_start.seconds();
  CheckReport check = examine(mesh, run);
  if (!line.before.empty()) check.topology_differences.emplace();
  if (check.measurable) {
    check.topology = topology(mesh);
    if (!line.before.empty()) {
      check.topology_before = topology(read_checked(line.before, run, field_found));
      check.topology_differences = topology_differences(*check.topology_before, *check.topology);
    }
  }
  if (check.measurable && !line.surfaces.empty()) {
    run.progress.begin_stage("compare");
    compare_with_surfaces(mesh, run, check);
  }
  // The error of the reader lists the fields that there are. Streams and objects cannot be read twice.
  const bool read_once = !line.input_format.empty() || is_object(run, line.inputs.front());
  if (!line.material_field.empty() && !field_found && read_once)
    throw InputError(line.inputs.front(), 0,
                     "it has no whole-number cell field '" + line.material_field + "'");
  if (!line.material_field.empty() && !field_found)
    (void)read_tet_mesh(line.inputs.front(), {line.material_field});
  if (!(check.valid() && check.topology_kept() && check.within_tolerance()))
    run.report.status = ExitStatus::short_of_request;
  run.report.seconds_total = run.since_start.seconds();
  OutputFiles files(&run.progress);
  if (check.measurable) write_report(mesh, run, files, &check);
  write_stats(run, files);
  files.commit();
  return check;
}

void run_check(CommandRun& run) {
  const CommandLine& line = run.line;
  const CheckReport check = make_check(run);
  run.progress.finish();
  if (!line.quiet) print_notes(notes_of(run.report));
  if (line.stats == "-") std::printf("%s\n", stats_json(line, run.report).c_str());
  if (line.json)
    std::printf("%s\n", check_json(line, run.report, check).c_str());
  else if (line.quiet || line.stats == "-")
    print_shortfalls(check);
  else
    print_check(check, run);
}

}  // namespace tetwright

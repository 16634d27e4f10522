// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "tetwright/error.h"
#include "tetwright/files.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/mesher_input.h"
#include "tetwright/prepare_steps.h"
#include "tetwright/resources.h"
#include "tools/app/commands/command_run.h"
#include "tools/app/commands/commands.h"
#include "tools/app/commands/output_paths.h"
#include "tools/app/commands/report_file.h"
#include "tools/app/commands/surfaces_of_mesh.h"
#include "tools/app/printed_report.h"
#include "tools/report/stats_json.h"

namespace tetwright {

namespace {

/// Peak memory of the process, bytes: its libraries, and for each tet the mesh with its topology. A knot of
/// 116,000 tets takes 20 MB.
constexpr double program_bytes = 40e6;
constexpr double bytes_per_tet = 180;

/// Reads a mesh to check or to compare with.
/// \param field_found set to true if the mesh has the field of --material-field
TetMesh read_checked(Input input, CommandRun& run, bool& field_found) {
  const std::string& file = input.name;
  // With --before one of the meshes may lack the field: a mesh made from the other one has the field
  // `material`.
  double waited = 0;
  ReadTetMesh read =
      take_tet_mesh(input, {run.line.options.material_field, run.line.check.before.empty()}, waited);
  field_found |= read.material_field == run.line.options.material_field;
  if (file == run.line.inputs.front()) run.report.material_field = read.material_field;
  (void)join_read_interfaces(read, file, run.report);
  report_dropped(read.dropped, file, run.report, !run.line.check.json);
  return std::move(read.mesh);
}

/// Checks and measures the mesh. Only checks it if indices or coordinates are invalid.
CheckReport examine(TetMesh& mesh, CommandRun& run) {
  CheckReport check;
  check.findings = check_mesh(mesh);
  for (const MeshFinding& f : check.findings)
    check.measurable &= f.code > DiagnosticCode::coordinates_not_finite;
  if (!check.measurable) return check;
  mesh.interfaces = interfaces_with_sheets(mesh);
  run.report.result = mesh_statistics(mesh, run.line.options.shapes.bound());
  run.report.material_names = mesh.material_names;
  return check;
}

/// Reads the surfaces of --surface, with their names, into the space of the mesh.
/// \throws InputError if a surface does not meet the mesh
void read_surfaces(const TetMesh& mesh, CommandRun& run, std::vector<TriangleMesh>& surfaces,
                   std::vector<std::string>& names) {
  SpacesOfSurfaces spaces(mesh, run);
  const auto add = [&](TriangleMesh surface, const Input& input) {
    spaces.add(surface, input);
    surfaces.push_back(std::move(surface));
    names.push_back(input.name);
  };
  for (const std::string& file : run.line.check.surfaces) {
    Input input = input_named(file, run.line, run.in_memory);
    if (input.is_vdb_file()) {
      for (NamedSurface& s : read_level_sets(file)) add(std::move(s.surface), input);
      continue;
    }
    std::vector<Dropped> dropped;
    double waited = 0;
    add(take_surface(input, &dropped, waited), input);
    report_dropped(dropped, file, run.report, !run.line.check.json);
  }
  spaces.report();
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
  read_surfaces(mesh, run, surfaces, names);
  check.surface = compare_with_surfaces(mesh, surfaces, names);
  measure_distances(mesh, joined(surfaces), "the surfaces", run);
  const std::optional<Length>& tolerance = run.line.options.target.tolerance;
  if (tolerance) check.tolerance = tolerance_of(*tolerance, check.surface->diagonal);
}

const char* verdict(const CheckReport& check) {
  if (!check.valid()) return "not valid";
  if (!check.topology_kept()) return "valid, but with a different topology";
  return check.within_tolerance() ? "valid" : "valid, but not within the tolerance";
}

void print_check(const CheckReport& check, const CommandRun& run) {
  for (const MeshFinding& f : check.findings)
    std::printf("%s: %s\n", name_of(kind_of(f.code).severity), mesh_finding_line(f).c_str());
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

/// Prints errors and shortfalls to stderr; this is the only output with --quiet.
void print_shortfalls(const CheckReport& check) {
  for (const MeshFinding& f : check.findings)
    if (kind_of(f.code).severity == Severity::error) print_line(mesh_finding_line(f));
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
  Input input = input_named(line.inputs.front(), line, run.in_memory);
  // Read the input again for the reader's error, which lists its fields. Streams and values can be read only
  // once.
  const bool read_once = !std::holds_alternative<InputFile>(input.value);
  TetMesh mesh = read_checked(std::move(input), run, field_found);
  require_memory(program_bytes + bytes_per_tet * static_cast<double>(mesh.tets.size()),
                 line.inputs.front() + ": checking its " + std::to_string(mesh.tets.size()) + " tets",
                 "free some, or give a larger --memory-limit");
  run.progress.begin_stage("check");
  run.report.input_points = mesh.points.size();
  run.report.seconds_read = run.since_start.seconds();
  run.report.loops_read = run.since_start.loops();
  CheckReport check = examine(mesh, run);
  if (!line.check.before.empty()) check.topology_differences.emplace();
  if (check.measurable) {
    check.topology = topology(mesh);
    if (!line.check.before.empty()) {
      check.topology_before =
          topology(read_checked(input_named(line.check.before, line, run.in_memory), run, field_found));
      check.topology_differences = topology_differences(*check.topology_before, *check.topology);
    }
  }
  if (check.measurable && !line.check.surfaces.empty()) {
    run.progress.begin_stage("compare");
    compare_with_surfaces(mesh, run, check);
  }
  if (!line.options.material_field.empty() && !field_found && read_once)
    throw InputError(line.inputs.front(), 0,
                     "it has no whole-number cell field '" + line.options.material_field + "'");
  if (!line.options.material_field.empty() && !field_found)
    (void)read_tet_mesh(line.inputs.front(), {line.options.material_field});
  if (!(check.valid() && check.topology_kept() && check.within_tolerance()))
    run.status = ExitStatus::short_of_request;
  run.report.seconds_total = run.since_start.seconds();
  run.report.loops_total = run.since_start.loops();
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
  if (!line.console.quiet) print_notes(notes_of(run.report));
  if (line.outputs.stats == "-") std::printf("%s\n", stats_json(run).c_str());
  if (line.check.json)
    std::printf("%s\n", check_json(run, check).c_str());
  else if (line.console.quiet || line.outputs.stats == "-")
    print_shortfalls(check);
  else
    print_check(check, run);
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "tetwright/prepare_steps.h"

#include <algorithm>
#include <utility>

#include "common/message_text.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/sheets.h"
#include "tools/prepare/edge_sizes_input.h"
#include "tools/prepare/surface_spaces.h"

namespace tetwright {

namespace {

void check_input_kind(const Input& input, Task task) {
  const std::string& file = input.name;
  const FileKind kind = input.kind();
  if (kind == FileKind::surface || kind == FileKind::volume || is_vdb(file))
    throw UsageError(file + " is a " + (kind == FileKind::surface ? "surface" : "volume") +
                     ", which 'tetwright prepare' and 'tetwright mesh' read; " + name_of(task) +
                     " reads tet meshes (" + known_extensions(FileKind::tet_mesh) + ")");
}

/// Repairs meshes of other programs, which may list tets in the opposite orientation or repeat points for
/// each tet.
void repair(TetMesh& mesh, const std::string& file, PrepareReport& report) {
  const ImportCleanupReport found = make_coherent(mesh);
  const auto add = [&](DiagnosticCode code, std::size_t count, const char* what, const char* done,
                       std::vector<Vec3> places = {}) {
    if (count > 0)
      report.diagnostics.push_back({.code = code,
                                    .file = file,
                                    .what = what,
                                    .count = count,
                                    .done = done,
                                    .places = std::move(places)});
  };
  using enum DiagnosticCode;
  add(tet_points_merged, found.merged_points, "points repeated for each tet",
      "merged where coordinates are equal");
  add(tets_collapsed, found.removed_tets, "tets with a repeated vertex", "left out");
  add(tets_turned, found.turned_tets, "tets with reversed vertex order", "corrected");
  std::vector<Vec3> first;
  if (!found.first_inverted.empty()) first.push_back(mesh.points[mesh.tets[found.first_inverted.front()][0]]);
  add(tets_inverted, found.inverted_tets, "flat or negative tets", "kept unless the run repairs them", first);
  add(patch_faces_lost, found.lost_faces, "faces of named patches between tets that were merged",
      "no longer on the boundary, or in another patch from their other side");
  if (mesh.tets.empty()) throw InputError(file, 0, "all its tets have a repeated vertex; no tets remain");
}

/// The wedges of cohesive elements have six nodes, whatever the order of the tets.
void require_first_order_wedges(const std::vector<InterfaceToPart>& joined, const PrepareOptions& options,
                                const std::string& file) {
  if (options.order == 2 &&
      std::any_of(joined.begin(), joined.end(), [](const InterfaceToPart& part) { return part.cohesive; }))
    throw UsageError(file +
                     " has cohesive elements, which do not fit tets of second order; leave out --order 2");
}

}  // namespace

std::vector<InterfaceToPart> join_read_interfaces(ReadTetMesh& read, const std::string& file,
                                                  PrepareReport& report) {
  const JoinedInterfaces joined = join_parted_interfaces(read.mesh);
  if (joined.other_wedges > 0)
    read.dropped.push_back(
        {"cohesive elements between faces whose groups are not the sides of a parted interface",
         joined.other_wedges});
  if (joined.repeated_wedges > 0)
    read.dropped.push_back({"repeated cohesive elements", joined.repeated_wedges});
  if (joined.missing_wedges > 0)
    read.dropped.push_back(
        {"faces without a cohesive element on parted interfaces that have some, which all get one",
         joined.missing_wedges});
  for (const auto& [field, points] : joined.lost_values)
    read.dropped.push_back(
        {"values of the point field " + in_quotes(field) +
             " on the second sides of parted interfaces, which differ from those of the first",
         points});
  for (const auto& [name, faces] : joined.apart)
    report.diagnostics.push_back({.code = DiagnosticCode::sides_apart,
                                  .file = file,
                                  .what = "faces of the sides of the parted interface " + in_quotes(name) +
                                          " that do not coincide with one of the other side",
                                  .count = faces,
                                  .done = "the sides stay apart"});
  if (!joined.parts.empty())
    report.diagnostics.push_back(
        {.code = DiagnosticCode::interfaces_joined,
         .file = file,
         .what = "points on the two sides of parted interfaces (" + quoted_list(joined.names) + ")",
         .count = joined.points,
         .done = "joined for the work"});
  return joined.parts;
}

TetMesh read_tets_unchanged(Input from, PrepareRun& run) {
  const Stopwatch watch;
  run.progress.begin_stage("read");
  check_input_kind(from, run.task);
  ReadTetMesh read = take_tet_mesh(from, {run.options.material_field}, run.seconds_waited);
  run.report.material_field = read.material_field;
  run.report.space = space_of_tets(read.mesh, from.name, run.options.mesh_space, run.report);
  run.report.input_points = read.mesh.points.size();
  report_dropped(read.dropped, from.name, run.report);
  run.progress.throw_if_stopped();
  // A file with groups has all of them, with their patches.
  if (read.mesh.interfaces.empty()) read.mesh.interfaces = find_interfaces(read.mesh);
  run.report.patches = patches_of_input(read.mesh);
  run.report.material_names = read.mesh.material_names;
  run.report.result = mesh_statistics(read.mesh, run.options.shapes.bound());
  run.report.seconds_read = watch.seconds();
  run.report.loops_read = watch.loops();
  return std::move(read.mesh);
}

TetInput read_tets(Input from, PrepareRun& run) {
  const Stopwatch watch;
  const std::string& file = from.name;
  run.progress.begin_stage("read");
  check_input_kind(from, run.task);
  ReadTetMesh read = take_tet_mesh(from, {run.options.material_field}, run.seconds_waited);
  run.report.material_field = read.material_field;
  run.report.space = space_of_tets(read.mesh, file, run.options.mesh_space, run.report);
  run.report.input_points = read.mesh.points.size();
  run.progress.throw_if_stopped();
  std::vector<InterfaceToPart> joined = join_read_interfaces(read, file, run.report);
  require_first_order_wedges(joined, run.options, file);
  report_dropped(read.dropped, file, run.report);
  TetInput input{std::move(read.mesh), {}, std::move(joined)};
  repair(input.mesh, file, run.report);
  run.progress.throw_if_stopped();
  if (!input.mesh.point_fields.empty() || !input.mesh.cell_fields.empty()) {
    input.with_fields = input.mesh;
    input.mesh.point_fields.clear();
    input.mesh.cell_fields.clear();
  }
  run.report.patches = patches_of_input(input.mesh);
  if (run.options.feature_angle.rule != FeatureAngle::Rule::off) {
    run.report.features.push_back(
        {from.material_name(), find_mesh_patches(input.mesh, run.options.feature_angle, file)});
    run.report.features.back().found.patches = {};
  }
  run.progress.throw_if_stopped();
  run.report.creases = mesh_creases(input.mesh);
  run.report.seconds_read = watch.seconds();
  run.report.loops_read = watch.loops();
  // Comparing and writing a mesh take as long as reading it (5 s for each of these, for the 4.3 million tets
  // of dragon_vrip_res2.ply at --resolution 200); a simplified mesh takes less.
  const double finishing = run.report.seconds_read - run.seconds_waited;
  run.reserve_time(run.task == Task::improve ? finishing : std::min(finishing, run.seconds_left() / 2));
  const TargetOptions& target = run.options.target;
  if (target.tets && *target.tets > input.mesh.tets.size())
    throw UsageError("--target-tets " + std::to_string(*target.tets) + " is above the " +
                     std::to_string(input.mesh.tets.size()) + " tets of " + file + "; give fewer");
  Box3 box;
  for (const Vec3& p : input.mesh.points) box.add(p);
  read_sizes(run, box);
  require_sizes_at(run, input.mesh.points);
  run.report.dense = mesh_statistics(input.mesh, run.options.shapes.bound());
  if (target.tolerance) run.report.tolerance = tolerance_of(*target.tolerance, diagonal_of(input.mesh));
  return input;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/tet_input.h"

#include <utility>

#include "common/error.h"
#include "common/io/formats.h"
#include "common/mesh/import_cleanup.h"
#include "tools/app/commands/edge_sizes_input.h"
#include "tools/app/commands/scan_input.h"
#include "tools/app/commands/simplification.h"

namespace tetwright {

namespace {

void check_input_kind(const CommandRun& run) {
  const std::string& file = run.line.inputs.front();
  const FileKind kind = input_kind(run, file);
  if (kind == FileKind::surface || kind == FileKind::volume || is_vdb(file))
    throw UsageError(file + " is a " + (kind == FileKind::surface ? "surface" : "volume") +
                     ", which 'tetwright prepare' and 'tetwright mesh' take; " + name_of(run.line.command) +
                     " reads tet meshes (" + known_extensions(FileKind::tet_mesh) + ")");
}

/// Other programs list tets in the opposite orientation or repeat points for each tet.
void repair(TetMesh& mesh, const std::string& file, RunReport& report) {
  const ImportCleanupReport found = make_coherent(mesh);
  const auto add = [&](std::size_t count, const char* what, const char* done,
                       std::optional<Vec3> place = {}) {
    if (count) report.findings.push_back({file, {what, count, place, done}});
  };
  add(found.merged_points, "points repeated for each tet", "merged where coordinates are equal");
  add(found.removed_tets, "tets with a vertex twice", "left out");
  add(found.turned_tets, "tets listed the other way round", "turned");
  std::optional<Vec3> first;
  if (!found.first_inverted.empty()) first = mesh.points[mesh.tets[found.first_inverted.front()][0]];
  add(found.inverted_tets, "flat or negative tets", "kept unless the work puts them right", first);
  add(found.lost_faces, "faces of named patches between tets that were merged",
      "no longer of the boundary, or of another patch from their other side");
  if (mesh.tets.empty()) throw InputError(file, 0, "all its tets have a vertex twice; nothing is left of it");
}

}  // namespace

TetInput read_tets(CommandRun& run) {
  const Stopwatch watch;
  const std::string& file = run.line.inputs.front();
  run.progress.begin_stage("read");
  check_input_kind(run);
  ReadTetMesh read = take_tet_mesh(run, file, {run.line.material_field});
  run.report.material_field = read.material_field;
  run.report.input_points = read.mesh.points.size();
  run.progress.throw_if_stopped();
  report_dropped(read.dropped, file, run.report);
  TetInput input{std::move(read.mesh), {}};
  repair(input.mesh, file, run.report);
  run.progress.throw_if_stopped();
  if (!input.mesh.point_fields.empty() || !input.mesh.cell_fields.empty()) {
    input.with_fields = input.mesh;
    input.mesh.point_fields.clear();
    input.mesh.cell_fields.clear();
  }
  run.report.patches = patches_of_input(input.mesh);
  if (run.line.feature_angle.rule != FeatureAngle::Rule::off) {
    run.report.features.push_back(
        {material_name_of(run, file), find_mesh_patches(input.mesh, run.line.feature_angle, file)});
    run.report.features.back().found.patches = {};
  }
  run.progress.throw_if_stopped();
  run.report.creases = mesh_creases(input.mesh);
  run.report.seconds_read = watch.seconds();
  // Comparing and writing a mesh take as long as reading it (5 s each of the 4.3 million tets of
  // dragon_vrip_res2.ply at --resolution 200); what simplifying leaves of it takes less.
  const double finishing = run.report.seconds_read - run.seconds_waited;
  run.reserve_time(run.line.command == Command::improve ? finishing
                                                        : std::min(finishing, run.seconds_left() / 2));
  if (run.line.target_tets > input.mesh.tets.size())
    throw UsageError("--target-tets " + std::to_string(run.line.target_tets) + " is above the " +
                     std::to_string(input.mesh.tets.size()) + " tets of " + file + "; give fewer");
  Box3 box;
  for (const Vec3& p : input.mesh.points) box.add(p);
  read_sizes(run, box);
  require_sizes_at(run, input.mesh.points);
  run.report.dense = mesh_statistics(input.mesh, run.line.min_solid_angle);
  if (run.line.tolerance.value > 0) run.report.tolerance = tolerance_of(run.line, diagonal_of(input.mesh));
  return input;
}

}  // namespace tetwright

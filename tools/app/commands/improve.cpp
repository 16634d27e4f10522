// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <utility>

#include "common/mesh/field_transfer.h"
#include "tools/app/commands/commands.h"
#include "tools/app/commands/report_file.h"
#include "tools/app/commands/second_order.h"
#include "tools/app/commands/tet_input.h"
#include "tools/prepare/limiting_rules.h"

namespace tetwright {

namespace {

TetMesh improve_shapes(TetMesh mesh, CommandRun& run) {
  ImproveOptions options;
  options.only_below = run.line.only_below;
  options.min_solid_angle = run.line.min_solid_angle;
  options.objective = run.line.objective;
  options.fix_boundary = run.line.fix_boundary;
  options.free_count = run.line.free_count;
  options.max_iterations = run.line.max_iterations;
  options.seed = run.line.seed;
  options.name = run.report.inputs.front();
  run.report.simplify.emplace();
  return improve(std::move(mesh), options, &*run.report.simplify, &run.progress);
}

/// --only-below says which tets to work on, not what to reach. Tets that stay below it are a finding and no
/// shortfall.
void report_tets_below(const TetMesh& mesh, CommandRun& run) {
  const double bound = run.line.only_below;
  if (bound == 0) return;
  const MeshStatistics statistics = mesh_statistics(mesh, bound);
  const auto left = static_cast<std::size_t>(
      std::llround(statistics.below_percent / 100 * static_cast<double>(statistics.tets)));
  if (left == 0) return;
  char what[120];
  std::snprintf(what, sizeof what, "tets still below --only-below %.6g sr, the smallest at %.4g sr", bound,
                statistics.min_solid_angle);
  run.report.findings.push_back(
      {run.line.inputs.front(),
       {what, left, {}, "held back by: " + rules_limiting_shapes(*run.report.simplify)}});
}

}  // namespace

CommandResult run_improve(CommandRun& run) {
  TetInput input = read_tets(run);
  const std::optional<SurfaceToFollow> surface = followed_interfaces(input.mesh, run);
  const TriangleMesh before = surface_for_report(input.mesh, run);
  TetMesh mesh = improve_shapes(std::move(input.mesh), run);
  report_tets_below(mesh, run);
  measure_distances(mesh, before, "the mesh before", run);
  if (surface) make_second_order(mesh, *surface, run);
  if (input.with_fields) transfer_fields(*input.with_fields, mesh);
  input.with_fields.reset();
  return {std::move(mesh), nullptr};
}

}  // namespace tetwright

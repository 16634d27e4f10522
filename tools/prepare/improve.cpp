// SPDX-License-Identifier: Apache-2.0
#include "tetwright/prepare_steps.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "tetwright/mesh_quality.h"
#include "tetwright/simplify.h"
#include "tools/prepare/limiting_rules.h"

namespace tetwright {

namespace {

/// Reports tets that stay below the bound of --only-below. They are a finding, not a shortfall: the option
/// selects the tets to work on, and does not set a goal.
void report_tets_below(const TetMesh& mesh, PrepareRun& run) {
  const double bound = run.options.shapes.only_below.value_or(0);
  if (bound == 0) return;
  const MeshStatistics statistics = mesh_statistics(mesh, bound);
  const auto left = static_cast<std::size_t>(
      std::llround(statistics.below_percent / 100 * static_cast<double>(statistics.tets)));
  if (left == 0) return;
  char what[120];
  std::snprintf(what, sizeof what, "tets still below --only-below %.6g sr, the smallest at %.4g sr", bound,
                statistics.min_solid_angle);
  const std::string held = rules_limiting_shapes(*run.report.simplify);
  run.report.diagnostics.push_back({.code = DiagnosticCode::tets_still_below,
                                    .file = run.report.inputs.front(),
                                    .what = what,
                                    .count = left,
                                    .done = "limited by: " + held,
                                    .asked = bound,
                                    .reached = statistics.min_solid_angle,
                                    .limited_by = held});
}

}  // namespace

TetMesh improve_shapes(TetMesh mesh, PrepareRun& run) {
  const ShapeOptions& asked = run.options.shapes;
  ImproveOptions options;
  options.only_below = asked.only_below.value_or(0);
  options.min_solid_angle = asked.bound();
  options.objective = asked.objective;
  options.fix_boundary = asked.fix_boundary;
  options.free_count = asked.free_count;
  options.max_iterations = asked.max_iterations;
  options.seed = run.options.seed;
  options.name = run.report.inputs.front();
  run.report.simplify.emplace();
  TetMesh result = improve(std::move(mesh), options, &*run.report.simplify, &run.progress);
  report_tets_below(result, run);
  return result;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/fitting_sweeps.h"

#include "simplify/operations/collapse.h"
#include "simplify/operations/fitting.h"
#include "simplify/schedule/selection.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

void fit_interfaces(Engine& engine, float floor, double above) {
  const std::vector<Index> points = interface_points(
      engine.mesh(), [&](RegionId region) { return engine.ledger().utilization(region) > above; });
  engine.runner().each_star(points, Operation::fit,
                            [&](Workspace& ws) { return fit_to_samples(ws, engine.rules, floor); });
}

void fit_farthest_samples(Engine& engine, const std::vector<TetSnapshot>& tets, float floor) {
  engine.runner().each_star(points_around(engine.mesh(), tets), Operation::fit, [&](Workspace& ws) {
    return fit_to_samples(ws, engine.rules, floor, SampleWeights::squared_distance);
  });
}

void fit_feature_edges(Engine& engine) {
  if (!engine.projection().has_patches()) return;
  constexpr float floor = SimplifyTuning::Features::fitting_floor;
  BlockRules fitting = engine.rules;
  fitting.error.max.reset();
  fitting.acceptance.good_enough = floor;
  const std::vector<Index> points = points_off_features(engine.mesh(), engine.grid(), engine.projection());
  engine.runner().each_star(points, Operation::fit, [&](Workspace& ws) {
    const Outcome moved = fit_to_crease(ws, fitting, floor);
    if (moved == Outcome::done || moved == Outcome::no_candidate) return moved;
    if (ws.star.dimension() != 1 && !ws.is_crossing(fitting)) return moved;
    for (std::size_t b = 0; b < ws.star.points.size(); ++b)
      if (ws.star.edge_dimension(b) == 1 && collapse_onto(ws, fitting, b) == Outcome::done)
        return Outcome::done;
    return moved;
  });
}

}  // namespace tetwright

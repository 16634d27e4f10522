// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/local_refinement.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "simplify/operations/insertion.h"
#include "simplify/schedule/fitting_sweeps.h"
#include "simplify/schedule/improve_area.h"
#include "simplify/schedule/selection.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using Refinement = SimplifyTuning::Refinement;

/// The longest edge of a tet or, with `surface`, of its boundary and interface faces; index into tet_edges.
int longest_edge(const EditableMesh& mesh, const TetSnapshot& item, bool surface) {
  int longest = 0;
  double max_length = 0;
  for (int e = 0; e < 6; ++e) {
    const int p = tet_edges[e][0], q = tet_edges[e][1];
    const auto on_face = [&](int f) { return f != p && f != q && mesh.link(item.tet, f).is_interface(); };
    if (surface && !on_face(0) && !on_face(1) && !on_face(2) && !on_face(3)) continue;
    const double length = (mesh.position(item.points[p]) - mesh.position(item.points[q])).squaredNorm();
    if (length > max_length) longest = e, max_length = length;
  }
  return longest;
}

/// Halves the longest edge of each tet if the resulting tets keep a fraction of the shape bound.
void halve(const ImprovementTools& tools, const std::vector<TetSnapshot>& tets, const ImprovementPlan& plan,
           double angle, bool surface) {
  EditableMesh& mesh = tools.mesh;
  BlockRules halving = tools.rules;
  halving.error.max.reset();
  halving.acceptance.good_enough =
      Refinement::split_floor * static_cast<float>(shape_quality_bound(halving.objective.shape, angle));
  halving.count = {plan.min_tets, plan.max_tets};
  RoundRecorder::Round round(tools.recorder, plan.kind, 0);
  tools.runner.tets(
      tets,
      [&](Workspace& ws, const TetSnapshot& item, int) {
        if (!exists(mesh, item)) return Outcome::stale;
        return insert_in_edge(ws, halving, item.tet, longest_edge(mesh, item, surface),
                              InsertionPlace::centre, true);
      },
      [] { return false; });
  round.finish();
}

/// Tells whether rounds still gain: whether the number of remaining tets reached a new minimum recently.
class Gain {
 public:
  bool continues(std::size_t left) {
    idle_ = left < min_left_ ? 0 : idle_ + 1;
    min_left_ = std::min(min_left_, left);
    return idle_ <= Refinement::max_idle;
  }

 private:
  std::size_t min_left_ = std::numeric_limits<std::size_t>::max();
  int idle_ = 0;
};

}  // namespace

void refine_bad_tets(const ImprovementTools& tools, ImprovementArea& area, ImprovementPlan plan,
                     double angle) {
  const auto bound = static_cast<float>(shape_quality_bound(tools.rules.objective.shape, angle));
  Gain gain;
  for (int i = 0; i < Refinement::max_rounds && plan.max_rounds > 0; ++i) {
    const std::vector<TetSnapshot> bad = area.bad_tets(bound);
    if (bad.empty() || !gain.continues(bad.size())) return;
    halve(tools, area.tets_around(bad), plan, angle, false);
    plan.max_rounds -= improve_area(tools, area, plan, 1);
  }
}

void refine_beyond_tolerance(Engine& engine, ImprovementArea& area, const ImprovementPlan& plan, double angle,
                             double limit) {
  const ImprovementTools tools{engine.mesh(), engine.runner(), engine.rules, engine.recorder()};
  // Use this bound, since the plan's may leave points too little room to reach the tolerance.
  const auto floor = static_cast<float>(shape_quality_bound(engine.rules.objective.shape, angle));
  for (int i = 0; i < Refinement::max_rounds; ++i) {
    const std::vector<TetSnapshot> far =
        tets_with_faces(engine.mesh(), engine.input_samples().add_far_samples(limit));
    if (far.empty() ||
        static_cast<double>(far.size()) >
            std::max(Refinement::max_far_tets,
                     Refinement::max_far_share * static_cast<double>(engine.mesh().live_tets())))
      return;
    halve(tools, far, plan, angle, true);
    improve_area(tools, area, plan, 1);
    for (int sweep = 0; sweep < Refinement::far_fits; ++sweep) {
      RoundRecorder::Round round(tools.recorder, plan.kind, 0);
      fit_farthest_samples(engine, far, floor);
      round.finish();
    }
    refine_bad_tets(tools, area, plan, angle);
  }
}

}  // namespace tetwright

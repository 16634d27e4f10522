// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/local_refinement.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "simplify/operations/insertion.h"
#include "simplify/schedule/improve_area.h"

namespace tetwright {

namespace {

constexpr int max_refinements = 8;
/// Max number and max share of tets with far faces (the larger counts): above, local refinement does not
/// help.
constexpr double max_far_share = 0.02, max_far_tets = 100;
constexpr int far_fits = 2;  ///< fitting sweeps after each round
/// Max rounds without gain: each halves edges farther around.
constexpr int max_idle_refinements = 2;
/// Share of the shape bound that halved tets must have. Flips and smoothing improve them.
constexpr float split_floor = 0.3f;

/// The longest edge of a tet, or with `surface` of its boundary and interface faces; index into tet_edges.
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

/// Halves an edge of each tet if the resulting tets can be improved to that angle.
void halve(const ImprovementTools& tools, const std::vector<TetSnapshot>& tets, const ImprovementPlan& plan,
           double angle, bool surface) {
  EditableMesh& mesh = tools.mesh;
  BlockRules halving = tools.rules;
  halving.max_error = std::numeric_limits<double>::infinity();
  halving.good_enough = split_floor * static_cast<float>(shape_quality_bound(halving.objective.shape, angle));
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

/// Whether rounds still gain: the number of tets left has reached a new minimum recently.
class Gain {
 public:
  bool goes_on(std::size_t left) {
    idle_ = left < min_left_ ? 0 : idle_ + 1;
    min_left_ = std::min(min_left_, left);
    return idle_ <= max_idle_refinements;
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
  for (int i = 0; i < max_refinements && plan.max_rounds > 0; ++i) {
    const std::vector<TetSnapshot> bad = area.bad_tets(bound);
    if (bad.empty() || !gain.goes_on(bad.size())) return;
    halve(tools, area.tets_around(bad), plan, angle, false);
    plan.max_rounds -= improve_area(tools, area, plan, 1);
  }
}

void refine_beyond_tolerance(Engine& engine, ImprovementArea& area, const ImprovementPlan& plan, double angle,
                             double limit) {
  const ImprovementTools tools{engine.mesh(), engine.runner(), engine.rules, engine.recorder()};
  // Use this bound, not the plan's, which leaves a point less room than the tolerance may need.
  const auto floor = static_cast<float>(shape_quality_bound(engine.rules.objective.shape, angle));
  for (int i = 0; i < max_refinements; ++i) {
    const std::vector<TetSnapshot> far = engine.find_far_tets(limit);
    if (far.empty() ||
        static_cast<double>(far.size()) >
            std::max(max_far_tets, max_far_share * static_cast<double>(engine.mesh().live_tets())))
      return;
    halve(tools, far, plan, angle, true);
    improve_area(tools, area, plan, 1);
    for (int sweep = 0; sweep < far_fits; ++sweep) {
      RoundRecorder::Round round(tools.recorder, plan.kind, 0);
      engine.fit_far(far, floor);
      round.finish();
    }
    refine_bad_tets(tools, area, plan, angle);
  }
}

}  // namespace tetwright

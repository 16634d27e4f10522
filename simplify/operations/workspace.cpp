#include "simplify/operations/workspace.h"

#include <algorithm>

#include "simplify/constraints/surface_samples.h"
#include "simplify/operations/edge_turn.h"

namespace tetwright {

Outcome Workspace::gather(Index point) {
  const Outcome o = star.gather(mesh, point);
  if (o != Outcome::done || !mesh.interface_patches()) return o;
  bool inner = false;
  for (Star::InterfaceTriangle& t : star.interface_triangles)
    if (t.across != outside_id) {
      t.patch = grid.patch(mesh, {star.centre, star.points[t.first], star.points[t.second]});
      inner = true;
    }
  if (inner) star.find_creases();
  return o;
}

float Workspace::acceptance_limit(const BlockRules& rules, float worst) {
  const bool may_worsen = rules.accept_worse > 0 && random.uniform() < rules.accept_worse;
  return std::min(rules.good_enough, may_worsen ? rules.annealing_floor * worst : worst);
}

Outcome Workspace::test_surface(const BlockRules& rules) {
  if (!grid.test(proposal.edit)) return Outcome::self_intersection;
  const SurfaceSamples* samples = grid.samples();
  return !samples || samples->hand_over(proposal.edit, rules.max_deviation) ? Outcome::done
                                                                            : Outcome::surface_error;
}

Outcome Workspace::within_bounds(const BlockRules& rules, std::int64_t count_change) {
  if (!ledger.allows(proposal.volumes)) return Outcome::volume;
  if (folds_over(*this)) return Outcome::self_intersection;
  proposal.count_change = count_change;
  proposal.count_bounds = rules.count;
  return rules.count.allow(mesh.live_tets(), count_change) ? Outcome::done : Outcome::count;
}

}  // namespace tetwright

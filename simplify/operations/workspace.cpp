// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/workspace.h"

#include <algorithm>

#include "simplify/constraints/surface_samples.h"
#include "simplify/operations/edge_turn.h"

namespace tetwright {

namespace {

/// Share of the min length that new edges may have where the proposal removes one that is too long: halving
/// the edge of flat tets makes short ones, and nothing else shortens it.
constexpr double short_share_beside_long = 0.5;

/// Whether the proposal makes no edge too long or too short, or violates no bound by more than an edge that
/// it removes.
bool keeps_sizes(const Workspace& ws, const EdgeSizes& sizes) {
  const Proposal& p = ws.proposal;
  EdgeSizes::Excess before{1, 1}, after{0, 0};
  double short_share = 1;
  const auto add = [&](EdgeSizes::Excess& worst, const Vec3& a, const Vec3& b) {
    const EdgeSizes::Excess e = sizes.excess(a, b, short_share);
    worst.longer = std::max(worst.longer, e.longer);
    worst.shorter = std::max(worst.shorter, e.shorter);
  };
  if (p.change == Proposal::Change::replace) {
    const auto add_tet = [&](EdgeSizes::Excess& worst, const Tet& t) {
      const auto at = [&](Index id) { return id == unnumbered_point ? p.position : ws.mesh.position(id); };
      for (const auto& e : tet_edges) add(worst, at(t[e[0]]), at(t[e[1]]));
    };
    for (const Index t : p.removed) add_tet(before, ws.mesh.points(t));
    if (before.longer > 1) short_share = short_share_beside_long;
    for (const NewTet& t : p.added) add_tet(after, t.points);
  } else {
    const Star& star = ws.star;
    const bool moves = p.change == Proposal::Change::move;
    const Vec3& to = moves ? p.position : ws.mesh.position(p.target);
    for (std::size_t i = 0; i < star.points.size(); ++i) {
      add(before, star.centre_position, star.positions[i]);
      if (moves || star.points[i] != p.target) add(after, to, star.positions[i]);
    }
  }
  return after.longer <= before.longer && after.shorter <= before.shorter;
}

}  // namespace

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
  if (!samples || proposal.edit.removed.empty()) return Outcome::done;
  const double allowed = std::min(
      rules.tolerance, rules.max_deviation * rules.scale_at(proposal.edit.removed.front().points.front()));
  return samples->reassign_samples(proposal.edit, allowed) ? Outcome::done : Outcome::surface_error;
}

Outcome Workspace::within_bounds(const BlockRules& rules, std::int64_t count_change) {
  if (!ledger.allows(proposal.volumes)) return Outcome::volume;
  if (folds_over(*this)) return Outcome::self_intersection;
  if (rules.sizes && !keeps_sizes(*this, *rules.sizes)) return Outcome::edge_length;
  proposal.count_change = count_change;
  proposal.count_bounds = rules.count;
  return rules.count.allow(mesh.live_tets(), count_change) ? Outcome::done : Outcome::count;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/workspace.h"

#include <algorithm>

#include "simplify/constraints/surface_samples.h"
#include "simplify/operations/edge_turn.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using EdgeLengths = SimplifyTuning::EdgeLengths;

/// Whether no edge of the changed tets violates a bound by a larger factor than their worst edge did before.
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
    if (before.longer > 1) short_share = EdgeLengths::short_share_beside_long;
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

Outcome Workspace::gather(Index point) { return gather(point, star); }

Outcome Workspace::gather(Index point, Star& into) const {
  const Outcome o = into.gather(mesh, point);
  if (o != Outcome::done || !mesh.interface_patches()) return o;
  bool inner = false;
  for (Star::InterfaceTriangle& t : into.interface_triangles)
    if (t.across != outside_id) {
      t.patch = grid.patch(mesh, {into.centre, into.points[t.first], into.points[t.second]});
      inner = true;
    }
  if (inner) into.find_creases();
  return o;
}

float Workspace::acceptance_limit(const BlockRules& rules, float worst) {
  const bool may_worsen =
      rules.acceptance.worse_probability > 0 && random.uniform() < rules.acceptance.worse_probability;
  const float limit = may_worsen ? rules.acceptance.worse_floor * worst : worst;
  return rules.acceptance.good_enough ? std::min(*rules.acceptance.good_enough, limit) : limit;
}

Outcome Workspace::test_surface(const BlockRules& rules) {
  if (!grid.test(proposal.edit)) return Outcome::self_intersection;
  const SurfaceSamples* samples = grid.samples();
  if (!samples || proposal.edit.removed.empty()) return Outcome::done;
  const double allowed = rules.deviation.limit(rules.scale_at(proposal.edit.removed.front().points.front()));
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

const std::vector<std::size_t>& Workspace::bounded_curves(const BlockRules& rules) {
  const bool among_labels = rules.first_body_patch() != 0;
  if (among_labels) star.find_curves(rules.first_body_patch(), kinds);
  curve_ends.clear();
  for (std::size_t p = 0; p < star.points.size(); ++p)
    if (star.edge_dimension(p) == 1 && !(among_labels && kinds[p].follows_voxels())) curve_ends.push_back(p);
  return curve_ends;
}

double Workspace::max_curve_distance(const BlockRules& rules, std::size_t p) const {
  return rules.first_body_patch() == 0 || kinds[p].on_crease() ? *rules.surface.max_feature_distance
                                                               : rules.surface.max_label_distance;
}

bool Workspace::follows_one_crease(const BlockRules& rules) {
  if (rules.first_body_patch() == 0 || !star.creases) return false;
  star.find_curves(rules.first_body_patch(), kinds);
  return star.dimension_on_bodies(rules.first_body_patch(), kinds) == 1;
}

bool Workspace::is_on_crease(const BlockRules& rules) {
  // Contacts of bodies lie between labels as well; the given surface may not have them.
  return follows_one_crease(rules) &&
         std::any_of(kinds.begin(), kinds.end(),
                     [](const CurveKinds& k) { return k.on_crease() && !k.between_labels(); }) &&
         !rules.surface.projection->lacks_creases(star.centre_position);
}

bool Workspace::may_be_corner(const BlockRules& rules) {
  if (rules.first_body_patch() == 0) return true;
  star.find_curves(rules.first_body_patch(), kinds);
  return star.dimension_on_bodies(rules.first_body_patch(), kinds) == 0;
}

bool Workspace::is_crossing(const BlockRules& rules) {
  return !star.frozen && follows_one_crease(rules) && star.dimension_among_labels(kinds) == 1;
}

bool Workspace::may_cross_at(const BlockRules& rules, std::size_t b) {
  if (kinds[b].between_labels()) return true;
  if (gather(star.points[b], target_star) != Outcome::done) return false;
  target_star.find_curves(rules.first_body_patch(), target_kinds);
  return target_star.dimension_among_labels(target_kinds) == 2;
}

bool Workspace::is_on_label_curve(const BlockRules& rules) {
  if (rules.first_body_patch() == 0 || star.dimension() != 1) return false;
  star.find_curves(rules.first_body_patch(), kinds);
  for (std::size_t p = 0; p < star.points.size(); ++p)
    if (star.edge_dimension(p) == 1 && !kinds[p].follows_voxels()) return false;
  return true;
}

bool Workspace::may_merge_with(const BlockRules& rules, std::size_t b) {
  if (star.edge_dimension(b) != 2) return false;
  if (gather(star.points[b], target_star) != Outcome::done) return false;
  target_star.find_curves(rules.first_body_patch(), target_kinds);
  return target_star.dimension_among_labels(target_kinds) == 2 &&
         target_star.dimension_on_bodies(rules.first_body_patch(), target_kinds) == 1;
}

}  // namespace tetwright

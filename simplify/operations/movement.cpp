// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/movement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/tolerances.h"

namespace tetwright {

namespace {

/// Fills the proposal's edit with the interface triangles before and after the move. False if an added one is
/// too far from the reference. At junctions that points may leave, find_position() has tested the point
/// itself instead: if a junction curve has a loop smaller than a tet, a triangle's centroid may have no
/// interface of its two regions nearby.
bool surface_edit(Workspace& ws, const BlockRules& rules, const Vec3& to) {
  const Star& star = ws.star;
  // Crossings slide along their crease without that test.
  const bool crosses = rules.first_body_patch() != 0 && star.creases;
  const bool by_point = rules.surface.leave_surface && star.dimension() < 2 && !crosses;
  SurfaceGrid::Edit& edit = ws.proposal.edit;
  for (const Star::InterfaceTriangle& s : star.interface_triangles) {
    const Triangle ids{star.centre, star.points[s.first], star.points[s.second]};
    const Vec3 &p = star.positions[s.first], &q = star.positions[s.second];
    edit.removed.push_back({ids, {star.centre_position, p, q}});
    edit.added.push_back({{ids, {to, p, q}}, s.patch, s.inside, s.across});
    if (!by_point && !near_reference(rules, edit.added.back(), s.inside, s.across)) return false;
  }
  return true;
}

/// Whether a point where patches meet stays near its feature edge at `to`.
bool stays_near_crease(Workspace& ws, const BlockRules& rules, const Vec3& to) {
  const Star& star = ws.star;
  if (!rules.keeps_curves(star)) return true;
  const std::vector<std::size_t>& ends = ws.bounded_curves(rules);
  // Without labels around bodies only points of dimension 1 move, and corners onto those of the input.
  if (rules.first_body_patch() == 0 || ends.size() == 2)
    return ends.size() < 2 ||
           near_crease(rules, star, ws.max_curve_distance(rules, ends[0]), ends[0], to, ends[1]);
  return std::all_of(ends.begin(), ends.end(), [&](std::size_t p) {
    return near_crease(rules, star, ws.max_curve_distance(rules, p), p, to);
  });
}

}  // namespace

double shortest_edge(const Star& star) {
  double shortest2 = std::numeric_limits<double>::infinity();
  for (const Vec3& p : star.positions)
    shortest2 = std::min(shortest2, (p - star.centre_position).squaredNorm());
  return std::sqrt(shortest2);
}

bool is_flat(const Star& star) {
  const Vec3 normal = star.surface_normal().normalized();
  return std::all_of(star.interface_triangles.begin(), star.interface_triangles.end(),
                     [&](const Star::InterfaceTriangle& s) {
                       const auto off = [&](std::size_t p) {
                         return std::fabs(normal.dot(star.positions[p] - star.centre_position));
                       };
                       return std::max(off(s.first), off(s.second)) <= tolerance::flat_patch;
                     });
}

bool is_in_flat_patch(const Star& star, const BlockRules& rules) {
  return rules.first_body_patch() != 0 && !star.interface_triangles.empty() &&
         rules.surface.projection->is_flat(star.interface_triangles.front().patch) && star.dimension() == 2;
}

Outcome rate(Star& star, const BlockRules& rules, const Vec3& to, float limit, std::vector<float>& qualities,
             float& worst) {
  if (!star.interface_triangles.empty() &&
      star.surface_error(to - star.centre_position, rules.error.gamma, rules.error.losses_cancel) >
          rules.error.limit())
    return Outcome::surface_error;
  worst = 1;
  for (std::size_t k = 0; k < star.tets.size(); ++k) {
    const Star::StarTet& t = star.tets[k];
    qualities[k] =
        rules.objective(to, star.positions[t.link[0]], star.positions[t.link[1]], star.positions[t.link[2]]);
    if (!(qualities[k] > limit)) return Outcome::quality;
    worst = std::min(worst, qualities[k]);
  }
  return Outcome::done;
}

Outcome move_to(Workspace& ws, const BlockRules& rules, const Vec3& to, const std::vector<float>& qualities) {
  Star& star = ws.star;
  Proposal& proposal = ws.proposal;
  proposal.edit.clear();
  if (!star.interface_triangles.empty()) {
    if (!surface_edit(ws, rules, to) || !stays_near_crease(ws, rules, to)) return Outcome::surface_error;
    if (const Outcome o = ws.test_surface(rules); o != Outcome::done) return o;
  }
  proposal.volumes = star.volume_changes(to - star.centre_position);
  proposal.change = Proposal::Change::move;
  proposal.centre = star.centre;
  proposal.position = to;
  proposal.claim_star(star);
  proposal.rated.clear();
  for (std::size_t k = 0; k < star.tets.size(); ++k)
    proposal.rated.push_back({star.tets[k].tet, star.tets[k].slot, qualities[k]});
  return ws.within_bounds(rules, 0);
}

}  // namespace tetwright

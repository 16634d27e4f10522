// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/collapse.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/point_triangle.h"
#include "simplify/operations/collapse_table.h"

namespace tetwright {

namespace {

/// Rank of a refusal, higher for later tests. The refusal with the highest rank is reported.
int depth(Outcome o) {
  switch (o) {
    case Outcome::count:
      return 7;
    case Outcome::edge_length:
    case Outcome::self_intersection:
    case Outcome::volume:
      return 6;
    case Outcome::link_condition:
      return 5;
    case Outcome::quality:
      return 4;
    case Outcome::inverts:
      return 3;
    case Outcome::surface_error:
      return 2;
    case Outcome::material_rule:
      return 1;
    default:
      return 0;
  }
}

/// Distance of the centre from the triangles that replace its interface triangles.
double distance_left(const Star& star, std::size_t b) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Star::InterfaceTriangle& s : star.interface_triangles)
    if (s.first != b && s.second != b)
      nearest = std::min(nearest, squared_distance(star.centre_position, star.positions[b],
                                                   star.positions[s.first], star.positions[s.second]));
  return std::sqrt(nearest);
}

/// Fills the proposal's edit with the interface triangles before and after the collapse. False if an added
/// triangle is too far from the reference.
bool surface_edit(Workspace& ws, const BlockRules& rules, std::size_t b) {
  const Star& star = ws.star;
  SurfaceGrid::Edit& edit = ws.proposal.edit;
  edit.clear();
  if (rules.keeps_curves(star) && (star.edge_dimension(b) == 1 || star.dimension() == 1))
    for (const std::size_t p : ws.bounded_curves(rules))
      if (p != b && !near_crease(rules, star, ws.max_curve_distance(rules, p), p, star.positions[b]))
        return false;
  for (const Star::InterfaceTriangle& s : star.interface_triangles) {
    const Triangle ids{star.centre, star.points[s.first], star.points[s.second]};
    const Vec3 &p = star.positions[s.first], &q = star.positions[s.second];
    edit.removed.push_back({ids, {star.centre_position, p, q}});
    if (s.first == b || s.second == b) continue;
    edit.added.push_back(
        {{{star.points[b], ids[1], ids[2]}, {star.positions[b], p, q}}, s.patch, s.inside, s.across});
    if (!near_reference(rules, edit.added.back(), s.inside, s.across)) return false;
  }
  return true;
}

/// Closes the gap left by a tet with both ends of the edge: links the neighbours across its faces opposite
/// these ends to each other, and assigns other incident tets to its points.
void close_gap(const EditableMesh& mesh, Proposal& proposal, Index tet) {
  const int slot_a = mesh.slot_of(tet, proposal.centre), slot_b = mesh.slot_of(tet, proposal.target);
  const FaceLink across_a = mesh.link(tet, slot_a), across_b = mesh.link(tet, slot_b);
  /// Whether the face into which the tet's two faces merge is one of a sheet: one of them is, since the link
  /// condition refuses to merge two.
  const auto is_sheet = [&](Index side) {
    return mesh.region(side) == mesh.region(tet) && (across_a.is_interface() || across_b.is_interface());
  };
  /// The link from the neighbour on one side to the other one.
  const auto joined = [&](Index side, FaceLink other) {
    return other.is_outside()
               ? other
               : FaceLink::to(other.tet(), mesh.region(side) != mesh.region(other.tet()) || is_sheet(side));
  };
  for (const auto& [side, other] : {std::array{across_a, across_b}, std::array{across_b, across_a}})
    if (!side.is_outside())
      proposal.relinks.push_back({side.tet(), static_cast<std::uint8_t>(mesh.face_towards(side.tet(), tet)),
                                  joined(side.tet(), other)});
  // Both neighbours have the tet's two other points, and after the collapse both have b.
  const Index keeper = across_b.is_outside() ? across_a.tet() : across_b.tet();
  for (int k = 0; k < 4; ++k) {
    const Index p = mesh.points(tet)[k];
    if (k != slot_a && mesh.incident_tet(p) == tet) proposal.incidents.push_back({p, keeper});
  }
}

void propose(Workspace& ws, std::size_t b) {
  const EditableMesh& mesh = ws.mesh;
  const Star& star = ws.star;
  Proposal& proposal = ws.proposal;
  proposal.change = Proposal::Change::collapse;
  proposal.centre = star.centre;
  proposal.target = star.points[b];
  proposal.claim_star(star);
  // Add the target to the read set, since its star was read as well.
  std::swap(proposal.write_set[1], proposal.write_set[1 + b]);
  proposal.read_set_size = 2;
  proposal.rated.clear();
  proposal.removed.clear();
  proposal.relinks.clear();
  proposal.incidents.clear();
  for (std::size_t i = 0; i < star.tets.size(); ++i) {
    const Star::StarTet& t = star.tets[i];
    if (t.links(b)) {
      proposal.removed.push_back(t.tet);
      close_gap(mesh, proposal, t.tet);
    } else {
      proposal.rated.push_back({t.tet, t.slot, ws.qualities[i]});
    }
  }
}

/// Whether the strip between a curve between labels and a crease at link point b is narrow for the curve.
/// \pre Workspace::is_on_label_curve()
bool is_narrow_strip(const Workspace& ws, std::size_t b) {
  const Star& star = ws.star;
  double longest = 0;
  for (std::size_t p = 0; p < star.points.size(); ++p)
    if (ws.kinds[p].between_labels())
      longest = std::max(longest, (star.positions[p] - star.centre_position).norm());
  return (star.positions[b] - star.centre_position).norm() <=
         SimplifyTuning::Features::max_strip_width * longest;
}

/// Runs all tests but the weight for the target with local number b.
/// \param crossing Workspace::is_crossing()
/// \pre an edge of another dimension than the centre's satisfies Workspace::may_merge_with()
Outcome try_target(Workspace& ws, const BlockRules& rules, std::size_t b, bool crossing) {
  Star& star = ws.star;
  std::vector<float>& qualities = ws.qualities;
  const Vec3& to = star.positions[b];
  // Test orientation first: it is the cheapest test and fails most often.
  std::size_t left = 0;
  double min_det = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < star.tets.size(); ++k) {
    const Star::StarTet& t = star.tets[k];
    if (t.links(b)) continue;
    ++left;
    const double det = (star.positions[t.link[0]] - to).dot(star.normals[k]);
    if (!(det > 0)) return Outcome::inverts;
    min_det = std::min(min_det, det);
  }
  // If no tet of the star remains, an ear of the boundary is cut off. Each tet must then have a neighbour
  // opposite the centre that does not contain it.
  if (left == 0)
    for (const Star::StarTet& t : star.tets)
      if (const Index below = ws.mesh.neighbour(t.tet, t.slot);
          below == no_index || contains(ws.mesh.points(below), star.centre))
        return Outcome::link_condition;
  if (rules.collapse.max_new_edge &&
      std::any_of(star.positions.begin(), star.positions.end(),
                  [&](const Vec3& p) { return (p - to).norm() > *rules.collapse.max_new_edge; }))
    return Outcome::quality;
  ws.proposal.volumes = star.volume_changes(to - star.centre_position);
  if (!ws.ledger.allows(ws.proposal.volumes)) return Outcome::volume;
  const float limit = ws.acceptance_limit(rules, star.worst);
  if (!(rules.objective.max_for_volume(min_det) > limit)) return Outcome::quality;
  qualities.resize(star.tets.size());
  for (std::size_t k = 0; k < star.tets.size(); ++k) {
    const Star::StarTet& t = star.tets[k];
    if (t.links(b)) continue;
    qualities[k] =
        rules.objective(to, star.positions[t.link[0]], star.positions[t.link[1]], star.positions[t.link[2]]);
    if (!(qualities[k] > limit)) return Outcome::quality;
  }
  // Bound the distance in addition to the paper's volume error, since the tip of a spike has hardly any
  // volume.
  if (!star.interface_triangles.empty() && rules.collapse.distance_weight &&
      *rules.collapse.distance_weight * distance_left(star, b) >
          rules.error.limit(rules.scale_at(star.centre_position)))
    return Outcome::surface_error;
  if (!(rules.embedded && star.interface_triangles.empty()) &&
      !(ws.link_condition.holds(ws.mesh, ws.grid, star, b, rules.first_body_patch()) &&
        (!crossing || ws.may_cross_at(rules, b))))
    return Outcome::link_condition;
  ws.proposal.edit.clear();
  if (!star.interface_triangles.empty()) {
    if (!surface_edit(ws, rules, b)) return Outcome::surface_error;
    if (const Outcome o = ws.test_surface(rules); o != Outcome::done) return o;
  }
  propose(ws, b);
  return ws.within_bounds(rules,
                          static_cast<std::int64_t>(left) - static_cast<std::int64_t>(star.tets.size()));
}

}  // namespace

double collapse_weight(Star& star, std::size_t b, const BlockRules& rules) {
  const Vec3 step = star.positions[b] - star.centre_position;
  return step.norm() + (star.interface_triangles.empty()
                            ? 0
                            : star.surface_error(step, rules.error.gamma, rules.error.losses_cancel));
}

Outcome collapse_onto(Workspace& ws, const BlockRules& rules, std::size_t b) {
  Star& star = ws.star;
  const bool crossing = ws.is_crossing(rules);
  const int along = crossing ? 1 : collapsible_edge(vertex_kind(star));
  if (along == never || star.edge_dimension(b) != along) return Outcome::material_rule;
  if (crossing && !ws.kinds[b].on_crease()) return Outcome::material_rule;
  star.compute_normals();
  star.compute_gradients();
  if (collapse_weight(star, b, rules) > rules.error.limit()) return Outcome::surface_error;
  return try_target(ws, rules, b, crossing);
}

Outcome collapse(Workspace& ws, const BlockRules& rules) {
  Star& star = ws.star;
  const bool crossing = ws.is_crossing(rules);
  const int along = crossing ? 1 : collapsible_edge(vertex_kind(star));
  if (along == never) return Outcome::material_rule;
  const bool on_label_curve = !crossing && ws.is_on_label_curve(rules);
  star.compute_normals();
  star.compute_gradients();

  std::vector<CollapseTarget>& targets = ws.targets;
  targets.clear();
  const double max_error = rules.error.limit(rules.scale_at(star.centre_position));
  Outcome refusal = Outcome::material_rule;
  for (std::size_t p = 0; p < star.points.size(); ++p) {
    if (star.edge_dimension(p) != along
            ? !on_label_curve || !is_narrow_strip(ws, p) || !ws.may_merge_with(rules, p)
            : crossing && !ws.kinds[p].on_crease())
      continue;
    if (rules.collapse.max_collapsed_edge &&
        (star.positions[p] - star.centre_position).norm() > *rules.collapse.max_collapsed_edge)
      continue;
    if (rules.collapse.short_edges_only &&
        !(rules.sizes->excess(star.centre_position, star.positions[p]).shorter > 1))
      continue;
    const double weight = collapse_weight(star, p, rules);
    if (weight > max_error) {
      refusal = Outcome::surface_error;
      continue;
    }
    targets.push_back({weight, static_cast<std::uint16_t>(p)});
  }
  const std::size_t count = std::min(rules.collapse.max_targets, targets.size());
  std::partial_sort(targets.begin(), targets.begin() + static_cast<std::ptrdiff_t>(count), targets.end(),
                    [](const CollapseTarget& x, const CollapseTarget& y) {
                      return x.weight != y.weight ? x.weight < y.weight : x.point < y.point;
                    });
  for (std::size_t i = 0; i < count; ++i) {
    const Outcome o = try_target(ws, rules, targets[i].point, crossing);
    if (o == Outcome::done) return o;
    if (depth(o) > depth(refusal)) refusal = o;
  }
  return refusal;
}

}  // namespace tetwright

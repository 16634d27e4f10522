#include "simplify/operations/collapse.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/point_triangle.h"

namespace tetwright {

namespace {

/// Rank of a refusal: the higher, the later the test that refused. The highest is reported.
int depth(Outcome o) {
  switch (o) {
    case Outcome::count:
      return 7;
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

bool has(const Star::StarTet& t, std::size_t point) {
  return t.link[0] == point || t.link[1] == point || t.link[2] == point;
}

/// How far the centre lies from what takes the place of its interface triangles.
double distance_left(const Star& star, std::size_t b) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Star::InterfaceTriangle& s : star.interface_triangles)
    if (s.first != b && s.second != b)
      nearest = std::min(nearest, squared_distance(star.centre_position, star.positions[b],
                                                   star.positions[s.first], star.positions[s.second]));
  return std::sqrt(nearest);
}

/// Fills ws.edit with the interface triangles before and after; false if one is too far from the reference.
bool surface_edit(Workspace& ws, const BlockRules& rules, std::size_t b) {
  const Star& star = ws.star;
  ws.edit.clear();
  for (const Star::InterfaceTriangle& s : star.interface_triangles) {
    const Triangle ids{star.centre, star.points[s.first], star.points[s.second]};
    const Vec3 &p = star.positions[s.first], &q = star.positions[s.second];
    ws.edit.removed.push_back({ids, {star.centre_position, p, q}});
    if (s.first == b || s.second == b) continue;
    ws.edit.added.push_back({{star.points[b], ids[1], ids[2]}, {star.positions[b], p, q}});
    if (!near_reference(rules, ws.edit.added.back(), s.inside, s.across)) return false;
  }
  return true;
}

/// Joins the two outer neighbours of a tet that vanishes, across its faces opposite the ends of the collapsed
/// edge.
void close_gap(EditableMesh& mesh, const TetRecord& gone, Index tet, Index a, Index b) {
  const int slot_a = mesh.slot_of(tet, a), slot_b = mesh.slot_of(tet, b);
  const Index across_a = gone.neighbours[slot_a], across_b = gone.neighbours[slot_b];
  if (across_a != no_index) mesh.set_neighbour(across_a, mesh.face_towards(across_a, tet), across_b);
  if (across_b != no_index) mesh.set_neighbour(across_b, mesh.face_towards(across_b, tet), across_a);
  // Both keep the tet's two other points, and after the collapse both have b.
  const Index keeper = across_b != no_index ? across_b : across_a;
  for (int k = 0; k < 4; ++k)
    if (k != slot_a) mesh.set_incident_tet(gone.points[k], keeper);
}

void carry_out(Workspace& ws, std::size_t b, const std::vector<float>& qualities) {
  EditableMesh& mesh = ws.mesh;
  const Star& star = ws.star;
  const Index b_id = star.points[b];
  for (const Star::StarTet& t : star.tets) {
    if (!has(t, b)) continue;
    close_gap(mesh, mesh.tet(t.tet), t.tet, star.centre, b_id);
  }
  for (std::size_t i = 0; i < star.tets.size(); ++i) {
    const Star::StarTet& t = star.tets[i];
    if (has(t, b)) continue;
    mesh.store_point(t.tet, t.slot, b_id);
    mesh.set_quality(t.tet, qualities[i]);
    // Every point of the star keeps a tet: incident_tets to vanished ones are replaced by ones that stay.
    for (Index p : mesh.tet(t.tet).points) mesh.set_incident_tet(p, t.tet);
  }
  for (const Star::StarTet& t : star.tets) {
    if (!has(t, b)) continue;
    mesh.store_points(t.tet, dead_tet);
    ws.free_tets.give_back(t.tet);
  }
  for (Index p : star.points) mesh.touch(p);
  mesh.set_incident_tet(star.centre, no_index);
  ws.free_points.give_back(star.centre);
}

/// Everything but the weight, for the target with local number b; on trial nothing is changed.
Outcome try_target(Workspace& ws, const BlockRules& rules, std::size_t b, bool trial = false) {
  Star& star = ws.star;
  std::vector<float>& qualities = ws.qualities;
  const Vec3& to = star.positions[b];
  // Orientation first: the cheapest test, and the one that fails most often.
  std::size_t left = 0;
  for (const Star::StarTet& t : star.tets) {
    if (has(t, b)) continue;
    ++left;
    const Vec3 &x = star.positions[t.link[0]], &y = star.positions[t.link[1]], &z = star.positions[t.link[2]];
    if (!((x - to).dot((y - x).cross(z - x)) > 0)) return Outcome::inverts;
  }
  // The whole star vanishes where each of its tets stands on another: an ear of the boundary is cut off.
  if (left == 0)
    for (const Star::StarTet& t : star.tets)
      if (const Index below = ws.mesh.neighbour(t.tet, t.slot);
          below == no_index || contains(ws.mesh.tet(below).points, star.centre))
        return Outcome::link_condition;
  const float limit = ws.acceptance_limit(rules, star.worst);
  qualities.resize(star.tets.size());
  for (std::size_t k = 0; k < star.tets.size(); ++k) {
    const Star::StarTet& t = star.tets[k];
    if (has(t, b)) continue;
    qualities[k] =
        rules.objective(to, star.positions[t.link[0]], star.positions[t.link[1]], star.positions[t.link[2]]);
    if (!(qualities[k] > limit)) return Outcome::quality;
  }
  // Beside the paper's volumes: the tip of a spike has next to none.
  if (!star.interface_triangles.empty() && rules.distance_weight > 0 &&
      rules.distance_weight * distance_left(star, b) > rules.max_error)
    return Outcome::surface_error;
  if (!ws.link_condition.holds(ws.mesh, star, b)) return Outcome::link_condition;
  if (!star.interface_triangles.empty()) {
    if (!surface_edit(ws, rules, b)) return Outcome::surface_error;
    const Outcome o = ws.grid.begin_edit(ws.edit, ws.grid_workspace, ws.cells);
    if (o != Outcome::done) {
      ws.cells.release();
      return o;
    }
  }
  if (trial) {
    ws.cells.release();
    return Outcome::done;
  }
  const auto& volumes = star.volume_changes(to - star.centre_position);
  if (!ws.ledger.book(volumes)) {
    ws.cells.release();
    return Outcome::volume;
  }
  // Last of all, since what is taken off the count here is not put back.
  const auto change = static_cast<std::int64_t>(left) - static_cast<std::int64_t>(star.tets.size());
  if (!ws.mesh.change_count(change, rules.min_tets, rules.max_tets)) {
    ws.ledger.take_back(volumes);
    ws.cells.release();
    return Outcome::count;
  }
  carry_out(ws, b, qualities);
  if (!star.interface_triangles.empty()) {
    ws.grid.commit(ws.edit, ws.grid_workspace);
    ws.cells.release();
  }
  return Outcome::done;
}

/// What touches in a point only stays as it is.
bool may_go(const Star& star, int dimension) { return dimension > 0 && !star.near_pinned; }

}  // namespace

double collapse_weight(Star& star, std::size_t b, const BlockRules& rules) {
  const Vec3 step = star.positions[b] - star.centre_position;
  return step.norm() +
         (star.interface_triangles.empty() ? 0 : star.surface_error(step, rules.gamma, rules.losses_cancel));
}

Outcome collapse_onto(Workspace& ws, const BlockRules& rules, std::size_t b, bool trial) {
  Star& star = ws.star;
  const int dimension = star.dimension();
  if (!may_go(star, dimension) || star.edge_dimension(b) != dimension) return Outcome::material_rule;
  star.compute_gradients();
  if (collapse_weight(star, b, rules) > rules.max_error) return Outcome::surface_error;
  return try_target(ws, rules, b, trial);
}

Outcome collapse(Workspace& ws, const BlockRules& rules) {
  Star& star = ws.star;
  const int dimension = star.dimension();
  if (!may_go(star, dimension)) return Outcome::material_rule;
  star.compute_gradients();

  std::vector<CollapseTarget>& targets = ws.targets;
  targets.clear();
  Outcome refusal = Outcome::material_rule;
  for (std::size_t p = 0; p < star.points.size(); ++p) {
    if (star.edge_dimension(p) != dimension) continue;
    const double weight = collapse_weight(star, p, rules);
    if (weight > rules.max_error) {
      refusal = Outcome::surface_error;
      continue;
    }
    targets.push_back({weight, static_cast<std::uint16_t>(p)});
  }
  const std::size_t count = std::min(rules.max_targets, targets.size());
  std::partial_sort(targets.begin(), targets.begin() + static_cast<std::ptrdiff_t>(count), targets.end(),
                    [](const CollapseTarget& x, const CollapseTarget& y) {
                      return x.weight != y.weight ? x.weight < y.weight : x.point < y.point;
                    });
  for (std::size_t i = 0; i < count; ++i) {
    const Outcome o = try_target(ws, rules, targets[i].point);
    if (o == Outcome::done || o == Outcome::lock_taken) return o;
    if (depth(o) > depth(refusal)) refusal = o;
  }
  return refusal;
}

}  // namespace tetwright

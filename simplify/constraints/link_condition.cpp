#include "simplify/constraints/link_condition.h"

#include <algorithm>

namespace tetwright {

namespace {

/// Whether an edge with so many interface triangles lies on a junction curve.
bool on_junction(std::uint16_t interfaces) { return interfaces != 0 && interfaces != 2; }

bool has(const Star::StarTet& t, std::size_t point) {
  return t.link[0] == point || t.link[1] == point || t.link[2] == point;
}

}  // namespace

bool LinkCondition::holds(const EditableMesh& mesh, const Star& star, std::size_t b) {
  begin(mesh, star, b);
  read_interfaces_of_a();
  return walk_star_of_b() && vertices_agree() && interface_edges_agree();
}

void LinkCondition::begin(const EditableMesh& mesh, const Star& star, std::size_t b) {
  mesh_ = &mesh;
  star_ = &star;
  b_ = b;
  a_id_ = star.centre;
  b_id_ = star.points[b];
  a_on_boundary_ = b_on_boundary_ = a_on_junction_ = false;
  common_.assign(star.points.size(), {});
  boundary_at_a_.assign(star.points.size(), 0);
  local_of_a_.clear();
  tet_numbers_.clear();
  walk_.clear();
  other_points_.clear();
  other_interfaces_.clear();
  bool added;
  for (Index p : star.points) local_of_a_.number(p, added);
}

void LinkCondition::read_interfaces_of_a() {
  for (const Star::InterfaceTriangle& s : star_->interface_triangles) {
    const bool outside = s.across == outside_id;
    a_on_boundary_ |= outside;
    if (outside) {
      ++boundary_at_a_[s.first];
      ++boundary_at_a_[s.second];
    }
    if (s.first != b_ && s.second != b_) continue;
    Common& c = common_[s.first == b_ ? s.second : s.first];
    c.interface_with_ab = true;
    c.boundary_with_ab |= outside;
  }
  for (std::uint16_t count : star_->interface_count) a_on_junction_ |= on_junction(count);
}

bool LinkCondition::walk_star_of_b() {
  // Begins at a tet of the edge ab.
  bool added;
  for (const Star::StarTet& t : star_->tets)
    if (has(t, b_)) {
      tet_numbers_.number(t.tet, added);
      walk_.push_back(t.tet);
      break;
    }
  for (std::size_t i = 0; i < walk_.size(); ++i) {
    if (walk_.size() > 4 * Star::max_points) return false;
    const Index tet = walk_[i];
    const int slot = mesh_->slot_of(tet, b_id_);
    const LinkTriangle triangle = link_triangle(tet, slot);
    read_faces_at_b(tet, slot);
    if (shares_simplex(triangle)) return false;
  }
  return true;
}

LinkCondition::LinkTriangle LinkCondition::link_triangle(Index tet, int slot) {
  const Tet& points = mesh_->tet(tet).points;
  LinkTriangle triangle;
  triangle.has_a = std::find(points.begin(), points.end(), a_id_) != points.end();
  std::size_t m = 0;
  for (int k = 0; k < 4; ++k) {
    if (k == slot) continue;
    const Index p = points[k];
    const std::uint32_t local = p == a_id_ ? no_index : local_of_a_.find(p);
    triangle.points[m++] = local;
    if (local == no_index) continue;
    common_[local].seen = true;
    common_[local].with_ab |= triangle.has_a;
    ++triangle.in_a;
  }
  return triangle;
}

void LinkCondition::read_faces_at_b(Index tet, int slot) {
  const TetRecord& r = mesh_->tet(tet);
  for (int k = 0; k < 4; ++k) {
    if (k == slot) continue;
    const Index other = r.neighbours[k];
    if (other != no_index) {
      bool added;
      tet_numbers_.number(other, added);
      if (added) walk_.push_back(other);
      if (mesh_->tet(other).region == r.region || other < tet) continue;
    }
    const bool outside = other == no_index;
    b_on_boundary_ |= outside;
    for (int j = 0; j < 4; ++j)
      if (j != slot && j != k) count_interface(r.points[j], outside);
  }
}

void LinkCondition::count_interface(Index point, bool outside) {
  if (point == a_id_) return;
  if (const std::uint32_t k = local_of_a_.find(point); k != no_index) {
    ++common_[k].interfaces;
    common_[k].boundary += outside;
    return;
  }
  bool added;
  const std::uint32_t k = other_points_.number(point, added);
  if (added) other_interfaces_.push_back(0);
  ++other_interfaces_[k];
}

bool LinkCondition::shares_simplex(const LinkTriangle& triangle) const {
  if (triangle.has_a || triangle.in_a < 2) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t x = triangle.points[k], y = triangle.points[(k + 1) % 3];
    if (x == no_index || y == no_index) continue;
    bool edge_in_a = false, edge_with_ab = false;
    for (const Star::StarTet& s : star_->tets) {
      if (!has(s, x) || !has(s, y)) continue;
      edge_in_a = true;
      edge_with_ab |= has(s, b_);
    }
    if (edge_in_a && !edge_with_ab) return true;
  }
  return triangle.in_a == 3 &&
         std::any_of(star_->tets.begin(), star_->tets.end(), [&](const Star::StarTet& s) {
           return std::all_of(triangle.points.begin(), triangle.points.end(),
                              [&](std::uint32_t p) { return has(s, p); });
         });
}

bool LinkCondition::vertices_agree() const {
  const Star& star = *star_;
  bool b_on_junction = on_junction(star.interface_count[b_]);
  for (std::uint16_t count : other_interfaces_) b_on_junction |= on_junction(count);
  for (std::size_t p = 0; p < common_.size(); ++p)
    b_on_junction |= p != b_ && on_junction(common_[p].interfaces);

  // omega, and the edges of the links that end in it.
  if (a_on_boundary_ && b_on_boundary_ && boundary_at_a_[b_] == 0) return false;
  const bool ab_on_interface = star.interface_count[b_] != 0;
  const bool ab_on_junction = on_junction(star.interface_count[b_]);
  if (ab_on_interface && a_on_junction_ && b_on_junction && !ab_on_junction) return false;
  for (std::size_t p = 0; p < common_.size(); ++p) {
    if (p == b_ || !common_[p].seen) continue;
    const Common& c = common_[p];
    if (!c.with_ab) return false;
    if (boundary_at_a_[p] != 0 && c.boundary != 0 && !c.boundary_with_ab) return false;
    if (!ab_on_interface) continue;
    if (star.interface_count[p] != 0 && c.interfaces != 0 && !c.interface_with_ab) return false;
    if (on_junction(star.interface_count[p]) && on_junction(c.interfaces)) return false;
  }
  return true;
}

bool LinkCondition::interface_edges_agree() const {
  const Star& star = *star_;
  const bool ab_on_interface = star.interface_count[b_] != 0;
  for (const Star::InterfaceTriangle& s : star.interface_triangles) {
    if (s.first == b_ || s.second == b_) continue;
    if (!ab_on_interface && s.across != outside_id) continue;
    if (common_[s.first].interfaces == 0 || common_[s.second].interfaces == 0) continue;
    if (is_interface_of_b(star.points[s.first], star.points[s.second])) return false;
  }
  return true;
}

bool LinkCondition::is_interface_of_b(Index x, Index y) const {
  for (Index t : walk_) {
    const TetRecord& r = mesh_->tet(t);
    int opposite = -1;
    int hits = 0;
    for (int k = 0; k < 4; ++k) {
      const Index p = r.points[k];
      if (p == b_id_ || p == x || p == y)
        ++hits;
      else
        opposite = k;
    }
    if (hits == 3 && mesh_->region_across(t, opposite) != r.region) return true;
  }
  return false;
}

}  // namespace tetwright

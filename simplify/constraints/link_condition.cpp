// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/link_condition.h"

#include <algorithm>

#include "simplify/tuning/tuning.h"

namespace tetwright {

bool LinkCondition::holds(const EditableMesh& mesh, const SurfaceGrid& grid, const Star& star, std::size_t b,
                          PatchId first_body_patch) {
  first_body_patch_ = first_body_patch;
  begin(mesh, grid, star, b);
  read_interfaces_of_a();
  return walk_star_of_b() && surfaces_agree() && all_curves_agree() && interface_edges_agree();
}

bool LinkCondition::all_curves_agree() {
  if (star_->interface_count[b_] == 0) return true;
  if (first_body_patch_ == 0)
    return curves_agree([&](std::size_t p) { return star_->edge_dimension(p) == 1; },
                        [](const EdgeSheets& e) { return e.on_junction(); });
  star_->find_curves(first_body_patch_, kinds_);
  return curves_agree([&](std::size_t p) { return kinds_[p].on_crease(); },
                      [](const EdgeSheets& e) { return e.kinds.on_crease(); }) &&
         curves_agree([&](std::size_t p) { return kinds_[p].between_labels(); },
                      [](const EdgeSheets& e) { return e.kinds.between_labels(); });
}

void LinkCondition::begin(const EditableMesh& mesh, const SurfaceGrid& grid, const Star& star,
                          std::size_t b) {
  mesh_ = &mesh;
  grid_ = &grid;
  star_ = &star;
  b_ = b;
  a_id_ = star.centre;
  b_id_ = star.points[b];
  a_on_boundary_ = b_on_boundary_ = false;
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
}

bool LinkCondition::walk_star_of_b() {
  // Start at a tet of the edge ab.
  bool added;
  for (const Star::StarTet& t : star_->tets)
    if (t.links(b_)) {
      tet_numbers_.number(t.tet, added);
      walk_.push_back(t.tet);
      break;
    }
  for (std::size_t i = 0; i < walk_.size(); ++i) {
    if (walk_.size() > SimplifyTuning::Stars::max_walk) return false;
    const Index tet = walk_[i];
    const int slot = mesh_->slot_of(tet, b_id_);
    const LinkTriangle triangle = link_triangle(tet, slot);
    read_faces_at_b(tet, slot);
    if (shares_simplex(triangle)) return false;
  }
  return true;
}

LinkCondition::LinkTriangle LinkCondition::link_triangle(Index tet, int slot) {
  const Tet& points = mesh_->points(tet);
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
  const Tet& points = mesh_->points(tet);
  for (int k = 0; k < 4; ++k) {
    if (k == slot) continue;
    const FaceLink link = mesh_->link(tet, k);
    const bool outside = link.is_outside();
    if (!outside) {
      bool added;
      tet_numbers_.number(link.tet(), added);
      if (added) walk_.push_back(link.tet());
      if (!link.is_interface() || link.tet() < tet) continue;
    }
    b_on_boundary_ |= outside;
    const PatchId patch = outside ? link.patch() : grid_->patch(*mesh_, face_of(points, k));
    for (int j = 0; j < 4; ++j)
      if (j != slot && j != k) count_interface(points[j], outside, patch);
  }
}

void LinkCondition::count_interface(Index point, bool outside, PatchId patch) {
  if (point == a_id_) return;
  if (const std::uint32_t k = local_of_a_.find(point); k != no_index) {
    common_[k].interfaces.add(patch, first_body_patch_);
    common_[k].boundary += outside;
    return;
  }
  bool added;
  const std::uint32_t k = other_points_.number(point, added);
  if (added) other_interfaces_.push_back({});
  other_interfaces_[k].add(patch, first_body_patch_);
}

bool LinkCondition::shares_simplex(const LinkTriangle& triangle) const {
  if (triangle.has_a || triangle.in_a < 2) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t x = triangle.points[k], y = triangle.points[(k + 1) % 3];
    if (x == no_index || y == no_index) continue;
    bool edge_in_a = false, edge_with_ab = false;
    for (const Star::StarTet& s : star_->tets) {
      if (!s.links(x) || !s.links(y)) continue;
      edge_in_a = true;
      edge_with_ab |= s.links(b_);
    }
    if (edge_in_a && !edge_with_ab) return true;
  }
  return triangle.in_a == 3 &&
         std::any_of(star_->tets.begin(), star_->tets.end(), [&](const Star::StarTet& s) {
           return std::all_of(triangle.points.begin(), triangle.points.end(),
                              [&](std::uint32_t p) { return s.links(p); });
         });
}

bool LinkCondition::surfaces_agree() const {
  const Star& star = *star_;
  // Test ω, and the edges of the links that end in it.
  if (a_on_boundary_ && b_on_boundary_ && boundary_at_a_[b_] == 0) return false;
  const bool ab_on_interface = star.interface_count[b_] != 0;
  for (std::size_t p = 0; p < common_.size(); ++p) {
    if (p == b_ || !common_[p].seen) continue;
    const Common& c = common_[p];
    if (!c.with_ab) return false;
    if (boundary_at_a_[p] != 0 && c.boundary != 0 && !c.boundary_with_ab) return false;
    if (ab_on_interface && star.interface_count[p] != 0 && c.interfaces.count != 0 && !c.interface_with_ab)
      return false;
  }
  return true;
}

template <class AtA, class AtB>
bool LinkCondition::curves_agree(const AtA& at_a, const AtB& at_b) const {
  bool a_on_curve = false, b_on_curve = at_a(b_);
  for (std::size_t p = 0; p < common_.size(); ++p) {
    a_on_curve |= at_a(p);
    if (p != b_) b_on_curve |= at_b(common_[p].interfaces);
  }
  for (const EdgeSheets& e : other_interfaces_) b_on_curve |= at_b(e);
  if (a_on_curve && b_on_curve && !at_a(b_)) return false;
  for (std::size_t p = 0; p < common_.size(); ++p)
    if (p != b_ && common_[p].seen && at_a(p) && at_b(common_[p].interfaces)) return false;
  return true;
}

bool LinkCondition::interface_edges_agree() const {
  const Star& star = *star_;
  const bool ab_on_interface = star.interface_count[b_] != 0;
  for (const Star::InterfaceTriangle& s : star.interface_triangles) {
    if (s.first == b_ || s.second == b_) continue;
    if (!ab_on_interface && s.across != outside_id) continue;
    if (common_[s.first].interfaces.count == 0 || common_[s.second].interfaces.count == 0) continue;
    if (is_interface_of_b(star.points[s.first], star.points[s.second])) return false;
  }
  return true;
}

bool LinkCondition::is_interface_of_b(Index x, Index y) const {
  for (Index t : walk_) {
    const Tet& corners = mesh_->points(t);
    int opposite = -1;
    int hits = 0;
    for (int k = 0; k < 4; ++k) {
      const Index p = corners[k];
      if (p == b_id_ || p == x || p == y)
        ++hits;
      else
        opposite = k;
    }
    if (hits == 3 && mesh_->link(t, opposite).is_interface()) return true;
  }
  return false;
}

}  // namespace tetwright

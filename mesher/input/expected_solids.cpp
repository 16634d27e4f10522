// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/expected_solids.h"

#include <algorithm>

#include "common/geometry/self_intersection.h"
#include "common/geometry/surface_tree.h"

namespace tetwright {

namespace {

/// Number of queries of a surface above which a tree pays; each query without one visits every triangle.
constexpr std::size_t max_plain_queries = 16;

bool boxes_meet(const RepairedSurface& a, const RepairedSurface& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

/// Whether points off a closed surface are inside.
class Inside {
 public:
  Inside(const RepairedSurface& surface, std::size_t queries) : surface_(surface) {
    if (queries > max_plain_queries) tree_.emplace(surface.points, surface.triangles);
  }
  bool operator()(const Vec3& p) const {
    return (tree_ ? tree_->winding_number(p) : winding_number(surface_.points, surface_.triangles, p)) > 0.5;
  }

 private:
  const RepairedSurface& surface_;
  std::optional<SurfaceTree> tree_;
};

/// Whether surfaces meet each other.
bool meet(const RepairedSurface& body, const std::vector<const RepairedSurface*>& later) {
  std::vector<Vec3> points = body.points;
  std::vector<Triangle> triangles = body.triangles;
  for (const RepairedSurface* l : later) {
    const auto first = static_cast<Index>(points.size());
    points.insert(points.end(), l->points.begin(), l->points.end());
    for (const Triangle& t : l->triangles) triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return !self_intersections(points, triangles).empty();
}

/// The solid of a body without `later` ones, whose surfaces do not meet. Consists of the body's shells that
/// are in none of them, and of their shells inside the body, reversed, that are in no other one.
SolidShape carved_solid(const RepairedSurface& body, const SolidShape& solid,
                        const std::vector<const RepairedSurface*>& later,
                        const std::vector<SolidShape>& later_solids) {
  std::size_t shells = solid.shells.size();
  for (const SolidShape& s : later_solids) shells += s.shells.size();
  std::vector<Inside> inside_later;
  inside_later.reserve(later.size());
  for (const RepairedSurface* l : later) inside_later.emplace_back(*l, shells);
  const auto in_another = [&](const Vec3& p, std::size_t own) {
    for (std::size_t k = 0; k < later.size(); ++k)
      if (k != own && inside_later[k](p)) return true;
    return false;
  };
  SolidShape carved;
  for (const SolidShell& shell : solid.shells)
    if (!in_another(shell.place, later.size())) carved.shells.push_back(shell);
  const Inside inside_body(body, shells);
  for (std::size_t i = 0; i < later.size(); ++i)
    for (SolidShell shell : later_solids[i].shells) {
      if (!inside_body(shell.place) || in_another(shell.place, i)) continue;
      shell.volume = -shell.volume;
      carved.shells.push_back(shell);
    }
  return carved;
}

/// Nothing where edges have not just two triangles, or points more than one fan of them.
std::optional<SolidShape> clear_solid(const RepairedSurface& s) {
  if (s.closed != s.triangles.size() || s.intersects_itself) return {};
  SolidShape solid = solid_shape(s.points, s.triangles);
  if (!solid.manifold || solid.touches_itself) return {};
  return solid;
}

}  // namespace

std::vector<std::optional<SolidShape>> expected_solids(const MesherInput& input) {
  std::vector<std::optional<SolidShape>> own;
  own.reserve(input.bodies.size());
  for (const MesherInput::Body& body : input.bodies) own.push_back(clear_solid(body.surface));
  std::vector<std::optional<SolidShape>> solids(input.bodies.size());
  for (std::size_t i = 0; i < input.bodies.size(); ++i) {
    const RepairedSurface& body = input.bodies[i].surface;
    if ((i == 0 && !input.layers.empty()) || !own[i]) continue;
    std::vector<const RepairedSurface*> later;
    std::vector<SolidShape> later_solids;
    bool clear = true;
    for (std::size_t k = i + 1; k < input.bodies.size() && clear; ++k) {
      const RepairedSurface& other = input.bodies[k].surface;
      if (!boxes_meet(body, other)) continue;
      clear = own[k].has_value();
      if (!clear) break;
      later.push_back(&other);
      later_solids.push_back(*own[k]);
    }
    if (!clear || (!later.empty() && meet(body, later))) continue;
    solids[i] = carved_solid(body, *own[i], later, later_solids);
  }
  return solids;
}

}  // namespace tetwright

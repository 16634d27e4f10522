#include "mesher/input/expected_solids.h"

#include <algorithm>

#include "common/geometry/self_intersection.h"
#include "common/geometry/surface_tree.h"

namespace tetwright {

namespace {

/// Parts whose place is asked for one by one, at most: each takes a look at every triangle.
constexpr std::size_t max_parts = 64;

bool is_clean(const RepairedSurface& s) { return s.closed == s.triangles.size() && !s.intersects_itself; }

bool boxes_meet(const RepairedSurface& a, const RepairedSurface& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

enum class Place { inside, outside, unclear };

/// Where all parts of a solid lie, whose surface does not meet that of the other one.
Place place_in(const RepairedSurface& other, const SolidShape& solid) {
  if (solid.components() == 0 || solid.components() > max_parts) return Place::unclear;
  std::optional<bool> inside;
  for (const SolidShell& shell : solid.shells) {
    if (shell.volume <= 0) continue;
    const bool in = winding_number(other.points, other.triangles, shell.place) > 0.5;
    if (inside.value_or(in) != in) return Place::unclear;
    inside = in;
  }
  return *inside ? Place::inside : Place::outside;
}

/// The surfaces one after the other.
struct Joined {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  void add(const RepairedSurface& s, bool turned) {
    const auto first = static_cast<Index>(points.size());
    points.insert(points.end(), s.points.begin(), s.points.end());
    triangles.reserve(triangles.size() + s.triangles.size());
    for (Triangle t : s.triangles) {
      if (turned) std::swap(t[1], t[2]);
      triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
};

/// The solid of a body without `later` ones.
std::optional<SolidShape> carved_solid(const RepairedSurface& body,
                                       const std::vector<const RepairedSurface*>& later) {
  Joined all;
  all.add(body, false);
  for (const RepairedSurface* l : later) all.add(*l, false);
  if (!self_intersections(all.points, all.triangles).empty()) return {};
  std::vector<SolidShape> solids;
  solids.reserve(later.size());
  for (const RepairedSurface* l : later) solids.push_back(solid_shape(l->points, l->triangles));
  Joined carved;
  carved.add(body, false);
  for (std::size_t i = 0; i < later.size(); ++i) {
    bool carves = true;  // by itself, rather than as a part of another one
    for (std::size_t k = 0; k < later.size() && carves; ++k) {
      if (k == i || !boxes_meet(*later[i], *later[k])) continue;
      const Place place = place_in(*later[k], solids[i]);
      if (place == Place::unclear) return {};
      carves = place == Place::outside;
    }
    if (!carves) continue;
    const Place place = place_in(body, solids[i]);
    // One that is outside without meeting the body may still be all around it.
    if (place == Place::unclear) return {};
    if (place == Place::inside) carved.add(*later[i], true);
  }
  return solid_shape(carved.points, carved.triangles);
}

}  // namespace

std::vector<std::optional<SolidShape>> expected_solids(const MesherInput& input) {
  std::vector<std::optional<SolidShape>> solids(input.bodies.size());
  for (std::size_t i = 0; i < input.bodies.size(); ++i) {
    const RepairedSurface& body = input.bodies[i].surface;
    if (i == 0 && !input.layers.empty()) continue;
    std::vector<const RepairedSurface*> later;
    bool clean = is_clean(body);
    for (std::size_t k = i + 1; k < input.bodies.size() && clean; ++k) {
      const RepairedSurface& other = input.bodies[k].surface;
      if (!boxes_meet(body, other)) continue;
      later.push_back(&other);
      clean = is_clean(other);
    }
    if (!clean) continue;
    solids[i] = later.empty() ? solid_shape(body.points, body.triangles) : carved_solid(body, later);
    if (solids[i] && !solids[i]->manifold) solids[i].reset();
  }
  return solids;
}

}  // namespace tetwright

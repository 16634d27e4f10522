// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/region_extents.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <set>
#include <utility>

#include "common/geometry/surface_tree.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/tuning/input_tuning.h"

namespace tetwright {

namespace {

/// Area and volume below a triangle, the latter as that of its cone from an apex.
RegionExtent extent_below(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& apex) {
  return {(a - apex).dot((b - apex).cross(c - apex)) / 6, 0.5 * (b - a).cross(c - a).norm()};
}

/// Extents while they are added up.
class Extents {
 public:
  explicit Extents(std::size_t bodies) : by_body_(bodies), known_(bodies, 1) {}

  /// Adds a part of a surface to the regions behind and in front of it; 0 is the outside, b + 1 is body b.
  void add(const RegionExtent& part, std::size_t behind, std::size_t front) {
    if (behind > 0) {
      by_body_[behind - 1].area += part.area;
      by_body_[behind - 1].volume += part.volume;
    }
    if (front > 0) {
      by_body_[front - 1].area += part.area;
      by_body_[front - 1].volume -= part.volume;
    }
  }
  void count_part(std::size_t behind, std::size_t front, std::size_t RegionExtent::*kind) {
    if (behind > 0) ++(by_body_[behind - 1].*kind);
    if (front > 0) ++(by_body_[front - 1].*kind);
  }
  void forget(std::size_t body) { known_[body] = 0; }

  std::vector<std::optional<RegionExtent>> take() const {
    std::vector<std::optional<RegionExtent>> found(by_body_.size());
    for (std::size_t b = 0; b < found.size(); ++b)
      if (known_[b] && by_body_[b].volume > 0 && by_body_[b].area > 0) found[b] = by_body_[b];
    return found;
  }

 private:
  std::vector<RegionExtent> by_body_;
  std::vector<char> known_;
};

/// A connected part of a body's surface.
struct Component {
  RegionExtent extent;
  std::size_t triangles = 0;
  std::vector<Vec3> places;  ///< on it, spread over its triangles
};

std::vector<Component> components_of(const RepairedSurface& s) {
  std::vector<Index> parent(s.points.size());
  std::iota(parent.begin(), parent.end(), Index{0});
  const auto root = [&](Index p) {
    while (parent[p] != p) p = parent[p] = parent[parent[p]];
    return p;
  };
  for (const Triangle& t : s.triangles)
    for (const Index p : {t[1], t[2]}) {
      const Index a = root(t[0]), b = root(p);
      parent[std::max(a, b)] = std::min(a, b);
    }
  std::vector<Component> components;
  std::vector<std::size_t> number(s.points.size(), s.points.size());
  const Vec3 apex = 0.5 * s.low + 0.5 * s.high;
  for (const Triangle& t : s.triangles) {
    std::size_t& own = number[root(t[0])];
    if (own == s.points.size()) {
      own = components.size();
      components.emplace_back();
    }
    Component& c = components[own];
    const Vec3 &p = s.points[t[0]], &q = s.points[t[1]], &r = s.points[t[2]];
    const RegionExtent below = extent_below(p, q, r, apex);
    c.extent.area += below.area;
    c.extent.volume += below.volume;
    // Every triangle until there are enough, then ever fewer of them.
    ++c.triangles;
    constexpr std::size_t places = InputTuning::RegionExtents::places;
    if (c.places.size() < places)
      c.places.emplace_back((p + q + r) / 3);
    else if ((c.triangles & (c.triangles - 1)) == 0)
      c.places[c.triangles % places] = (p + q + r) / 3;
  }
  return components;
}

}  // namespace

std::vector<std::optional<RegionExtent>> region_extents(const MesherInput& input) {
  const std::size_t bodies = input.bodies.size();
  Extents extents(bodies);
  if (input.complex) {
    const LabelledComplex& complex = *input.complex;
    const Vec3 apex = 0.5 * input.low + 0.5 * input.high;
    std::set<std::pair<RegionIndex, RegionIndex>> pairs;
    for (const LabelledComplex::Face& f : complex.faces) {
      extents.add(
          extent_below(complex.points[f.ids[0]], complex.points[f.ids[1]], complex.points[f.ids[2]], apex),
          f.behind, f.front);
      pairs.insert(std::minmax(f.behind, f.front));
    }
    for (const auto& [first, second] : pairs) extents.count_part(first, second, &RegionExtent::open_parts);
    return extents.take();
  }
  std::vector<std::optional<SurfaceTree>> trees(bodies);
  const auto contains = [&](std::size_t body, const Vec3& p) {
    const RepairedSurface& s = input.bodies[body].surface;
    if ((p.array() < s.low.array()).any() || (p.array() > s.high.array()).any()) return false;
    if (!trees[body]) trees[body].emplace(s.points, s.triangles);
    return trees[body]->winding_number(p) > 0.5;
  };
  for (std::size_t b = 0; b < bodies; ++b)
    for (const Component& c : components_of(input.bodies[b].surface)) {
      // The last other body around each point; without any that of the outside.
      std::optional<std::size_t> around;
      bool crosses = false;
      for (const Vec3& p : c.places) {
        std::size_t here = 0;
        for (std::size_t other = bodies; other > 0 && here == 0; --other)
          if (other - 1 != b && contains(other - 1, p)) here = other;
        crosses |= around && *around != here;
        if (around && *around != here)
          for (const std::size_t region : {*around, here})
            if (region > 0) extents.forget(region - 1);
        around = here;
      }
      if (crosses) extents.forget(b);
      // A later body around it hides it.
      if (!around || *around > b + 1) continue;
      extents.add(c.extent, b + 1, *around);
      extents.count_part(b + 1, *around, &RegionExtent::closed_parts);
    }
  return extents.take();
}

RegionExtent extent_within(const RepairedSurface& surface) {
  RegionExtent all;
  for (const Component& c : components_of(surface)) {
    all.volume += c.extent.volume;
    all.area += c.extent.area;
    ++all.closed_parts;
  }
  return all;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/surface_nesting.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "common/geometry/ray_crossing.h"
#include "common/geometry/surface_tree.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/input_tuning.h"

namespace tetwright {

namespace {

struct Shape {
  Vec3 low, high;
  int sign = 0;       ///< 1 wound outwards, -1 inwards, 0 unclear
  double volume = 0;  ///< without sign
  Vec3 probe;         ///< one of its points, if possible one that no other component uses
  bool holds(const Shape& other) const {
    return (low.array() <= other.low.array()).all() && (high.array() >= other.high.array()).all();
  }
};

std::vector<Shape> shapes(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                          const std::vector<SurfaceComponent>& components) {
  std::vector<Index> user(points.size(), no_index);
  std::vector<char> shared(points.size(), 0);
  for (Index c = 0; c < components.size(); ++c)
    for (Index t : components[c].triangles)
      for (Index v : triangles[t]) {
        shared[v] |= user[v] != no_index && user[v] != c;
        user[v] = c;
      }
  std::vector<Shape> all(components.size());
  parallel_for(0, components.size(), InputGrains::components, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      Shape& shape = all[c];
      Index probe = triangles[components[c].triangles[0]][0];
      shape.low = shape.high = points[probe];
      for (Index t : components[c].triangles)
        for (Index v : triangles[t]) {
          shape.low = shape.low.cwiseMin(points[v]);
          shape.high = shape.high.cwiseMax(points[v]);
          if (shared[probe] && !shared[v]) probe = v;
        }
      shape.probe = points[probe];
      const Vec3 apex = 0.5 * shape.low + 0.5 * shape.high;
      double volume = 0;
      Vec3 area = Vec3::Zero();
      for (Index t : components[c].triangles) {
        const auto& [i, j, k] = triangles[t];
        const Vec3 a = points[i] - apex, b = points[j] - apex, d = points[k] - apex;
        volume += a.dot(b.cross(d)) / 6;
        area += (b - a).cross(d - a) / 2;
      }
      // With the apex moved by x, the volume is smaller by area . x / 3.
      const double range = components[c].closed ? 0 : area.cwiseAbs().dot(shape.high - apex) / 3;
      shape.volume = std::fabs(volume);
      if (shape.volume > range) shape.sign = volume > 0 ? 1 : -1;
    }
  });
  return all;
}

/// The probes of all shapes, sorted into square buckets of the xy plane.
class ProbeGrid {
 public:
  explicit ProbeGrid(const std::vector<Shape>& shapes) {
    low_ = high_ = shapes[0].probe;
    for (const Shape& s : shapes) low_ = low_.cwiseMin(s.probe), high_ = high_.cwiseMax(s.probe);
    side_ = static_cast<int>(std::sqrt(static_cast<double>(shapes.size()))) + 1;
    start_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_) + 1, 0);
    const auto bucket = [&](const Shape& s) { return place(cell(s.probe.x(), 0), cell(s.probe.y(), 1)); };
    for (const Shape& s : shapes) ++start_[bucket(s) + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    items_.resize(shapes.size());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for (Index i = 0; i < shapes.size(); ++i) items_[next[bucket(shapes[i])]++] = i;
  }

  /// Calls `body` for each probe that may be in the rectangle.
  template <class Body>
  void for_each(const Vec3& low, const Vec3& high, Body&& body) const {
    if (low.x() > high_.x() || low.y() > high_.y() || high.x() < low_.x() || high.y() < low_.y()) return;
    for (int y = cell(low.y(), 1); y <= cell(high.y(), 1); ++y)
      for (int x = cell(low.x(), 0); x <= cell(high.x(), 0); ++x)
        for (std::size_t k = start_[place(x, y)]; k < start_[place(x, y) + 1]; ++k) body(items_[k]);
  }

 private:
  int cell(double v, int axis) const {
    const double extent = high_[axis] - low_[axis];
    const double at = extent > 0 ? (v - low_[axis]) / extent : 0;
    return static_cast<int>(std::clamp(at, 0.0, 1.0) * (side_ - 1));
  }
  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(x);
  }
  Vec3 low_, high_;
  int side_;
  std::vector<std::size_t> start_;
  std::vector<Index> items_;
};

using Pairs = std::vector<std::pair<Index, Index>>;

std::pair<Index, Index> ascending(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// Pairs (inner, encloser) of components, sorted, determined only by the inner one's probe.
Pairs holding_probes(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                     const std::vector<SurfaceComponent>& components, const std::vector<Shape>& shapes) {
  struct Hit {
    Index inner, encloser;
    int crossing;
    auto operator<=>(const Hit&) const = default;
  };
  const ProbeGrid grid(shapes);
  std::vector<Hit> hits;
  Pairs pairs;
  for (Index c = 0; c < components.size(); ++c) {
    if (!components[c].closed) continue;
    for (Index t : components[c].triangles) {
      const Vec3 &a = points[triangles[t][0]], &b = points[triangles[t][1]], &d = points[triangles[t][2]];
      const Vec3 low = a.cwiseMin(b).cwiseMin(d), high = a.cwiseMax(b).cwiseMax(d);
      grid.for_each(low, high, [&](Index i) {
        if (i == c || !shapes[c].holds(shapes[i])) return;
        const Vec3& p = shapes[i].probe;
        if (const int crossing = vertical_crossing(a, b, d, p))
          if (at_or_above(a, b, d, crossing, p)) hits.push_back({i, c, crossing});
      });
    }
  }
  parallel_sort(hits);
  for (std::size_t i = 0, j; i < hits.size(); i = j) {
    int winding = 0;
    for (j = i; j < hits.size() && hits[j].inner == hits[i].inner && hits[j].encloser == hits[i].encloser;
         ++j)
      winding += hits[j].crossing;
    if (winding != 0) pairs.emplace_back(hits[i].inner, hits[i].encloser);
  }
  for (Index c = 0; c < components.size(); ++c) {
    if (components[c].closed) continue;
    std::unique_ptr<SurfaceTree> tree;
    for (Index i = 0; i < components.size(); ++i) {
      if (i == c || !shapes[c].holds(shapes[i])) continue;
      if (!tree) {
        std::vector<Triangle> own;
        for (Index t : components[c].triangles) own.push_back(triangles[t]);
        tree = std::make_unique<SurfaceTree>(points, own);
      }
      if (std::fabs(tree->winding_number(shapes[i].probe)) >= 0.5) pairs.emplace_back(i, c);
    }
  }
  parallel_sort(pairs);
  return pairs;
}

/// Pairs of different components that intersect, the smaller number first, sorted.
Pairs intersecting(const std::vector<SurfaceComponent>& components, std::size_t triangles,
                   const Pairs& crossing) {
  std::vector<Index> component(triangles, no_index);
  for (Index c = 0; c < components.size(); ++c)
    for (Index t : components[c].triangles) component[t] = c;
  Pairs pairs;
  for (const auto& [f, g] : crossing) {
    const Index a = component[f], b = component[g];
    if (a != b && a != no_index && b != no_index) pairs.push_back(ascending(a, b));
  }
  parallel_sort_unique(pairs);
  return pairs;
}

}  // namespace

ArrangedComponents arrange_components(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                                      const std::vector<SurfaceComponent>& components, const Pairs& crossing,
                                      NestedRule nested, std::vector<Diagnostic>& findings) {
  const std::size_t n = components.size();
  const std::vector<Shape> shape = shapes(points, triangles, components);
  std::vector<std::vector<Index>> enclosers(n);
  std::vector<char> meets_another(n, 0);
  if (n > 1) {
    const Pairs meeting = intersecting(components, triangles.size(), crossing);
    for (const auto& [a, b] : meeting) meets_another[a] = meets_another[b] = 1;
    for (const auto& [inner, encloser] : holding_probes(points, triangles, components, shape))
      if (!std::binary_search(meeting.begin(), meeting.end(), ascending(inner, encloser)))
        enclosers[inner].push_back(encloser);
  }

  // Process enclosers first. The nearest encloser is the most deeply nested one, and the smallest of several.
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index{0});
  const auto before = [&](Index a, Index b) {
    if (enclosers[a].size() != enclosers[b].size()) return enclosers[a].size() < enclosers[b].size();
    if (shape[a].volume != shape[b].volume) return shape[a].volume > shape[b].volume;
    return a < b;
  };
  std::sort(order.begin(), order.end(), before);

  ArrangedComponents result{std::vector<char>(n, 0), std::vector<char>(n, 0), {}};
  std::vector<char> solid(n, 1);  // just inside each component
  struct Count {
    std::size_t count = 0;
    std::optional<Vec3> place;
    void add(const Vec3& p) {
      if (count++ == 0) place = p;
    }
  } outwards, unclear, cavities, filled, alike, materials;
  for (Index c : order) {
    const int sign = shape[c].sign;
    const Vec3& place = shape[c].probe;
    if (sign == 0) unclear.add(place);
    if (enclosers[c].empty() || (nested == NestedRule::material && components[c].closed)) {
      result.turn[c] = sign < 0;
      if (!enclosers[c].empty()) {
        result.nested.push_back(c);
        materials.add(place);
      } else if (sign < 0) {
        outwards.add(place);
      }
      continue;
    }
    const Index parent = *std::max_element(enclosers[c].begin(), enclosers[c].end(), before);
    if (sign == 0) {
      solid[c] = solid[parent];
      result.turn[c] = result.turn[parent];
      continue;
    }
    const bool against = shape[parent].sign * sign < 0;
    const bool toggles = nested == NestedRule::cavity || (nested != NestedRule::solid && against);
    solid[c] = solid[parent] != toggles;
    result.turn[c] = (sign > 0) != (solid[c] != 0);
    result.redundant[c] = !toggles && components[c].closed && !meets_another[c];
    if (against && !toggles) filled.add(place);
    if (!against && toggles) cavities.add(place);
    if (!against && !toggles) alike.add(place);
  }
  add_finding(findings, DiagnosticCode::components_turned, "components oriented inwards", outwards.count,
              outwards.place, "reoriented outwards, each with everything that it encloses");
  add_finding(findings, DiagnosticCode::components_unclear, "open components whose outside is unclear",
              unclear.count, unclear.place, "kept as most of their triangles are wound");
  add_finding(findings, DiagnosticCode::components_alike, "enclosed components oriented like their enclosers",
              alike.count, alike.place, "part of the solid around them");
  add_finding(findings, DiagnosticCode::components_alternate,
              "enclosed components oriented like their enclosers", cavities.count, cavities.place,
              "solid and cavity alternate, as requested");
  add_finding(findings, DiagnosticCode::cavities_filled, "cavities", filled.count, filled.place,
              "filled, as requested");
  add_finding(findings, DiagnosticCode::components_separated, "enclosed components", materials.count,
              materials.place, "each a material of its own, as requested");
  return result;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/open_winding.h"

#include <algorithm>
#include <compare>
#include <cstdint>
#include <utility>

#include "common/geometry/ray_crossing.h"
#include "common/parallel/parallel_sort.h"

namespace tetwright {

namespace {

/// Closing triangles, as a share of the surface's, above which a tree of all triangles is as fast: a soup of
/// single triangles.
constexpr double max_closing_share = 0.5;

/// The edges that the triangles use more often in one direction than in the other, turned over and as often
/// as the difference. As many end at each vertex as begin there. Sorted by their first vertex.
std::vector<std::array<Index, 2>> turned_boundary(std::span<const Triangle> triangles) {
  struct Use {
    Index low, high;
    bool forwards;
    auto operator<=>(const Use&) const = default;
  };
  std::vector<Use> uses;
  uses.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  parallel_sort(uses);
  std::vector<std::array<Index, 2>> edges;
  for (std::size_t i = 0, j; i < uses.size(); i = j) {
    std::int64_t surplus = 0;
    for (j = i; j < uses.size() && uses[j].low == uses[i].low && uses[j].high == uses[i].high; ++j)
      surplus += uses[j].forwards ? 1 : -1;
    for (; surplus > 0; --surplus) edges.push_back({uses[i].high, uses[i].low});
    for (; surplus < 0; ++surplus) edges.push_back({uses[i].low, uses[i].high});
  }
  parallel_sort(edges);
  return edges;
}

/// Adds triangles that fill a closed curve, by rounds that each leave every other vertex.
void fill_curve(std::vector<Index> curve, std::vector<Triangle>& out) {
  while (curve.size() > 2) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < curve.size(); i += 2) {
      if (i + 1 < curve.size())
        out.push_back({curve[i], curve[i + 1], i + 2 < curve.size() ? curve[i + 2] : curve[0]});
      curve[kept++] = curve[i];
    }
    curve.resize(kept);
  }
}

}  // namespace

std::vector<Triangle> closing_triangles(std::span<const Triangle> triangles) {
  const std::vector<std::array<Index, 2>> edges = turned_boundary(triangles);
  if (edges.empty()) return {};
  Index last = 0;
  for (const auto& e : edges) last = std::max({last, e[0], e[1]});
  // The first edge from each vertex that is not used yet.
  std::vector<std::size_t> next(static_cast<std::size_t>(last) + 2, 0);
  for (const auto& e : edges) ++next[e[0] + 1];
  for (std::size_t v = 1; v < next.size(); ++v) next[v] += next[v - 1];
  const std::vector<std::size_t> first = next;

  constexpr std::size_t none = SIZE_MAX;
  std::vector<std::size_t> place(next.size(), none);  // of a vertex in `path`
  std::vector<Index> path;
  std::vector<Triangle> closing;
  for (const auto& start : edges) {
    // A walk along unused edges ends where it began. Where it comes to a vertex again, it has closed a curve.
    Index at = start[0];
    while (next[at] < first[at + 1]) {
      place[at] = path.size();
      path.push_back(at);
      at = edges[next[at]++][1];
      if (place[at] == none) continue;
      std::vector<Index> curve(path.begin() + static_cast<std::ptrdiff_t>(place[at]), path.end());
      path.resize(place[at]);
      for (const Index v : curve) place[v] = none;
      fill_curve(std::move(curve), closing);
    }
  }
  return closing;
}

OpenWinding::OpenWinding(std::span<const Vec3> points, std::span<const Triangle> triangles) : rest_({}, {}) {
  std::vector<Triangle> closing = closing_triangles(triangles);
  if (static_cast<double>(closing.size()) > max_closing_share * static_cast<double>(triangles.size())) {
    rest_ = SurfaceTree(points, triangles);
    return;
  }
  std::vector<std::array<Vec3, 3>> corners;
  corners.reserve(triangles.size() + closing.size());
  for (const std::span<const Triangle> part : {triangles, std::span<const Triangle>(closing)})
    for (const Triangle& t : part) corners.push_back({points[t[0]], points[t[1]], points[t[2]]});
  std::vector<Box3> boxes(corners.size());
  std::vector<Vec3> middles(corners.size());  // times 3
  for (std::size_t t = 0; t < corners.size(); ++t) {
    for (const Vec3& c : corners[t]) boxes[t].add(c);
    middles[t] = corners[t][0] + corners[t][1] + corners[t][2];
  }
  triangles_.reserve(corners.size());
  for (const Index t : median_order(boxes, middles, 1)) triangles_.push_back(corners[t]);
  tree_ = ReferenceTree(triangles_);
  for (Triangle& t : closing) std::swap(t[1], t[2]);
  rest_ = SurfaceTree(points, closing, 1);
}

double OpenWinding::winding_number(const Vec3& p) const {
  const int whole =
      triangles_.empty() ? 0 : winding_below(tree_, triangles_, p, [](std::size_t) { return true; });
  return whole + rest_.winding_number(p);
}

}  // namespace tetwright

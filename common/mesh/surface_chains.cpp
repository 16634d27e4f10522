// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/surface_chains.h"

#include <algorithm>
#include <tuple>

#include "common/mesh/disjoint_sets.h"

namespace tetwright {

namespace {

/// An edge of a triangle; each end has the corner 3 * triangle + its index in the triangle.
struct ChainSide {
  Index low, high;
  std::uint64_t low_corner, high_corner;
  bool operator<(const ChainSide& other) const {
    return std::tie(low, high, low_corner) < std::tie(other.low, other.high, other.low_corner);
  }
};

}  // namespace

SurfaceChains surface_chains(std::span<const Triangle> triangles) {
  std::vector<ChainSide> sides;
  sides.reserve(3 * triangles.size());
  // If an invalid triangle repeats a vertex, the vertex's fans are at its first occurrence.
  const auto corner = [&](std::size_t t, Index v) -> std::uint64_t {
    return 3 * t + static_cast<std::size_t>(std::find(triangles[t].begin(), triangles[t].end(), v) -
                                            triangles[t].begin());
  };
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      ChainSide side{a, b, corner(t, a), corner(t, b)};
      if (side.low > side.high) {
        std::swap(side.low, side.high);
        std::swap(side.low_corner, side.high_corner);
      }
      sides.push_back(side);
    }
  std::sort(sides.begin(), sides.end());

  SurfaceChains out;
  DisjointSets pieces(triangles.size()), fans(3 * triangles.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i > 0 && sides[i].low == sides[i - 1].low && sides[i].high == sides[i - 1].high) {
      ++out.edges.back().count;
      pieces.unite(static_cast<Index>(sides[i].low_corner / 3),
                   static_cast<Index>(sides[i - 1].low_corner / 3));
      fans.unite(static_cast<Index>(sides[i].low_corner), static_cast<Index>(sides[i - 1].low_corner));
      fans.unite(static_cast<Index>(sides[i].high_corner), static_cast<Index>(sides[i - 1].high_corner));
    } else {
      out.edges.push_back({{sides[i].low, sides[i].high}, 1});
    }
  }
  for (Index t = 0; t < triangles.size(); ++t) out.components += pieces.is_root(t);
  std::vector<Index> fan_points;
  for (Index c = 0; c < fans.size(); ++c)
    if (fans.is_root(c)) fan_points.push_back(triangles[c / 3][c % 3]);
  std::sort(fan_points.begin(), fan_points.end());
  for (std::size_t i = 0; i < fan_points.size(); ++i) {
    if (i == 0 || fan_points[i] != fan_points[i - 1]) {
      ++out.points;
      continue;
    }
    ++out.surplus_fans;
    if (out.touching_points.empty() || out.touching_points.back() != fan_points[i])
      out.touching_points.push_back(fan_points[i]);
  }
  return out;
}

}  // namespace tetwright

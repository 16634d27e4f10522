// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <algorithm>
#include <compare>
#include <cstdint>
#include <utility>

#include "common/mesh/disjoint_sets.h"
#include "common/parallel/parallel_sort.h"

namespace tetwright {

namespace {

/// An edge of a triangle, from corner `corner` to the next one.
struct Side {
  Index low, high;  ///< ids of the endpoints
  Index corner;     ///< 3 * triangle + index of the corner
  bool turned;      ///< true if it runs from high to low
  auto operator<=>(const Side&) const = default;
};

Index next_corner(Index corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

std::vector<Side> sorted_sides(std::span<const Triangle> triangles) {
  std::vector<Side> sides(3 * triangles.size());
  parallel_for(0, triangles.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (Index k = 0; k < 3; ++k) {
        const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
        sides[3 * t + k] = {std::min(a, b), std::max(a, b), static_cast<Index>(3 * t) + k, a > b};
      }
  });
  parallel_sort(sides);
  return sides;
}

}  // namespace

double SolidShape::volume() const {
  double sum = 0;
  for (const SolidShell& s : shells) sum += s.volume;
  return sum;
}

std::size_t SolidShape::components() const {
  return static_cast<std::size_t>(
      std::count_if(shells.begin(), shells.end(), [](const SolidShell& s) { return s.volume > 0; }));
}

std::ptrdiff_t SolidShape::handles() const {
  std::ptrdiff_t sum = 0;
  for (const SolidShell& s : shells) sum += s.handles;
  return sum;
}

SolidShape solid_shape(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  SolidShape shape;
  DisjointSets chained(triangles.size()), fans(3 * triangles.size());
  std::vector<Index> edges(triangles.size(), 0);  // edge counts, each at one of its triangles
  const std::vector<Side> sides = sorted_sides(triangles);
  for (std::size_t i = 0, j; i < sides.size(); i = j) {
    for (j = i + 1; j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high;) ++j;
    const Index corner = sides[i].corner;
    if (j - i != 2 || sides[i].turned == sides[i + 1].turned) {
      shape.manifold = false;
      for (std::size_t k = i; k < j; ++k) ++edges[sides[k].corner / 3];
      continue;
    }
    const Index other = sides[i + 1].corner;
    ++edges[corner / 3];
    chained.unite(corner / 3, other / 3);
    fans.unite(corner, next_corner(other));
    fans.unite(next_corner(corner), other);
  }

  std::vector<Index> shell_of(triangles.size());
  std::vector<std::ptrdiff_t> euler;
  std::vector<Index> fan_points;  // each point once for each of its fans
  for (Index t = 0; t < triangles.size(); ++t) {
    const Index root = chained.root(t);  // first triangle of the component
    if (root == t) {
      shell_of[t] = static_cast<Index>(shape.shells.size());
      shape.shells.push_back({.place = points[triangles[t][0]]});
      euler.push_back(0);
    } else {
      shell_of[t] = shell_of[root];
    }
    SolidShell& shell = shape.shells[shell_of[t]];
    ++shell.triangles;
    euler[shell_of[t]] += 1 - static_cast<std::ptrdiff_t>(edges[t]);
    for (Index k = 0; k < 3; ++k) {
      if (!fans.is_root(3 * t + k)) continue;
      ++euler[shell_of[t]];
      fan_points.push_back(triangles[t][k]);
    }
    const Vec3 a = points[triangles[t][0]] - shell.place, b = points[triangles[t][1]] - shell.place,
               c = points[triangles[t][2]] - shell.place;
    shell.volume += a.dot(b.cross(c)) / 6;
  }
  parallel_sort(fan_points);
  shape.touches_itself = std::adjacent_find(fan_points.begin(), fan_points.end()) != fan_points.end();
  for (std::size_t s = 0; s < shape.shells.size(); ++s) shape.shells[s].handles = (2 - euler[s]) / 2;
  return shape;
}

}  // namespace tetwright

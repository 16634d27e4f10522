// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "common/geometry/reference_tree.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Exact crossings of a triangle with the vertical line (parallel to z) through a point.
///
/// Lines through edges and vertices are decided as if shifted to (x + e, y + e^2) for an infinitely small e >
/// 0 (simulation of simplicity, Edelsbrunner & Muecke 1990). Every line then meets the triangles around an
/// edge or vertex consistently, and the crossings of a closed surface always cancel.

/// Crossing of the upward line through `point`, whose z is ignored.
/// \return 1 if the line enters the solid (the normal points down), -1 if it leaves, 0 if it misses the
///   triangle
int vertical_crossing(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point);

/// Whether `point` is on or above the triangle.
/// \pre its vertical line meets the triangle with `crossing` 1 or -1
bool at_or_above(const Vec3& a, const Vec3& b, const Vec3& c, int crossing, const Vec3& point);

/// The exact winding number at a point: the signed crossings of the line from below with triangles that are
/// the boundary of something, so that each edge has as many of them in either direction. On a triangle, that
/// of the point just below. \param tree of the triangles \param use `use(triangle)`: whether it counts
template <class Use>
int winding_below(const ReferenceTree& tree, std::span<const std::array<Vec3, 3>> triangles,
                  const Vec3& point, const Use& use) {
  int winding = 0;
  std::vector<Index> counted;  // of the triangles in several parts, which may be visited several times
  tree.for_each_in(
      [&](const Box3& box) {
        return box.low.x() <= point.x() && point.x() <= box.high.x() && box.low.y() <= point.y() &&
               point.y() <= box.high.y() && box.low.z() <= point.z();
      },
      [&](std::size_t t) {
        if (!use(t)) return;
        const auto& [a, b, c] = triangles[t];
        const int crossing = vertical_crossing(a, b, c, point);
        if (crossing == 0 || !at_or_above(a, b, c, crossing, point)) return;
        if (tree.is_split(t)) {
          if (std::find(counted.begin(), counted.end(), t) != counted.end()) return;
          counted.push_back(static_cast<Index>(t));
        }
        winding += crossing;
      });
  return winding;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Calls `visit(point)` for points of a triangle, its corners among them, each within about `spacing` of
/// others.
template <class Visit>
void for_each_point(const std::array<Vec3, 3>& corners, double spacing, const Visit& visit) {
  // From an end of the shortest edge, so that narrow triangles have few rows of points.
  std::size_t first = 0;
  const auto edge = [&](std::size_t k) -> Vec3 { return corners[(k + 1) % 3] - corners[k % 3]; };
  for (std::size_t k = 1; k < 3; ++k)
    if (edge(k).norm() < edge(first).norm()) first = k;
  const Vec3& a = corners[first];
  const Vec3 along = edge(first), across = -edge(first + 2);
  const auto steps = [&](const Vec3& e) {
    return std::max(1, static_cast<int>(std::ceil(e.norm() / spacing)));
  };
  const int n = steps(along), m = steps(across);
  for (int i = 0; i <= n; ++i)
    for (int k = 0; 1.0 * k * n <= 1.0 * (n - i) * m; ++k) visit(Vec3(a + along * i / n + across * k / m));
}

}  // namespace tetwright

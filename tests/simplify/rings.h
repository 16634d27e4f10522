// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// `n` tets around the edge of the points 0 (below) and 1 (above); the ring's points 2, 3, ... are at radius
/// 1.
///
/// \param open the tets span `angle`; otherwise a full turn.
/// \param material by index in the ring.
inline TetMesh ring_mesh(
    int n, double height, bool open = false, double angle = std::numbers::pi,
    MaterialTag (*material)(int) = [](int) { return MaterialTag{1}; }) {
  TetMesh mesh;
  mesh.points = {{0, 0, -height}, {0, 0, height}};
  const int points = open ? n + 1 : n;
  for (int i = 0; i < points; ++i) {
    const double a = (open ? angle : 2 * std::numbers::pi) * i / n;
    mesh.points.emplace_back(std::cos(a), std::sin(a), 0);
  }
  for (int i = 0; i < n; ++i) {
    mesh.tets.push_back({0, 1, static_cast<Index>(2 + i), static_cast<Index>(2 + (i + 1) % points)});
    mesh.materials.push_back(material(i));
  }
  return mesh;
}

}  // namespace tetwright

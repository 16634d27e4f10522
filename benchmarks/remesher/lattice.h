// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/random.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// n x n x n unit cubes of six tets each (Kuhn 1960), with a material on each side of the plane x = n / 2.
/// Points move by up to `amount` along each axis, but not off the boundary or the plane.
inline TetMesh jittered_lattice(int n, double amount, std::uint64_t seed) {
  TetMesh mesh;
  const auto number = [n](int x, int y, int z) {
    return static_cast<Index>(x + (n + 1) * (y + (n + 1) * z));
  };
  mesh.points.reserve(static_cast<std::size_t>(n + 1) * (n + 1) * (n + 1));
  mesh.tets.reserve(std::size_t{6} * n * n * n);
  mesh.materials.reserve(std::size_t{6} * n * n * n);
  Random random(seed);
  for (int z = 0; z <= n; ++z)
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x) {
        const std::array<int, 3> place{x, y, z};
        Vec3 p(x, y, z);
        for (int axis = 0; axis < 3; ++axis) {
          const double move = amount * (2 * random.uniform() - 1);
          const bool fixed = place[axis] == 0 || place[axis] == n || (axis == 0 && x == n / 2);
          if (!fixed) p[axis] += move;
        }
        mesh.points.push_back(p);
      }
  // Orders of the axes along paths from a cube's first corner to its last; odd permutations have the opposite
  // orientation.
  constexpr int ways[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        for (int way = 0; way < 6; ++way) {
          std::array<int, 3> at{x, y, z};
          Tet t;
          t[0] = number(at[0], at[1], at[2]);
          for (int i = 0; i < 3; ++i) {
            ++at[ways[way][i]];
            t[i + 1] = number(at[0], at[1], at[2]);
          }
          if (way >= 3) std::swap(t[2], t[3]);
          mesh.tets.push_back(t);
          mesh.materials.push_back(x < n / 2 ? 1 : 2);
        }
  return mesh;
}

}  // namespace tetwright

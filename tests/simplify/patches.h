// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "tests/simplify/meshes.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

/// Fills mesh.interfaces by find_interfaces(), with the patch of each triangle from its centroid.
inline void set_patches(TetMesh& mesh,
                        const std::function<std::uint16_t(const InterfaceTriangle&, const Vec3&)>& patch) {
  mesh.interfaces = find_interfaces(mesh);
  for (InterfaceTriangle& t : mesh.interfaces)
    t.patch = patch(t, (mesh.points[t.ids[0]] + mesh.points[t.ids[1]] + mesh.points[t.ids[2]]) / 3);
}

/// Moves points slightly, but keeps points on the sides of the cube [0, n]^3 and on planes with a coordinate
/// `kept`.
inline void jitter_inside(TetMesh& mesh, double n, std::uint64_t seed, double amount, double kept = -1) {
  Random random(seed);
  for (Vec3& p : mesh.points)
    for (int a = 0; a < 3; ++a) {
      const double by = amount * (random.uniform() - 0.5);
      if (p[a] != 0 && p[a] != n && p[a] != kept) p[a] += by;
    }
}

/// Number, 1 to 6, of the side of the cube [0, n]^3 nearest to a point.
inline std::uint16_t side_of(const Vec3& p, double n) {
  std::uint16_t nearest = 0;
  double distance = n;
  for (int a = 0; a < 3; ++a)
    for (int far = 0; far < 2; ++far)
      if (const double d = std::abs(p[a] - far * n); d < distance) {
        distance = d;
        nearest = static_cast<std::uint16_t>(1 + 2 * a + far);
      }
  return nearest;
}

/// The jittered cube [0, n]^3 with its sides as patches 1 to 6.
inline TetMesh cube_with_sides(int n, std::uint64_t seed, double amount = 0.3) {
  TetMesh mesh = grid_mesh(n);
  jitter_inside(mesh, n, seed, amount);
  set_patches(mesh, [&](const InterfaceTriangle&, const Vec3& c) { return side_of(c, n); });
  return mesh;
}

/// Two materials that meet in the plane x = n / 2. Its halves below and above y = n / 2 are patches 1 and 2.
inline TetMesh two_halves(int n, std::uint64_t seed, double amount = 0.3) {
  TetMesh mesh =
      grid_mesh({n, n, n}, [&](int x, int, int) { return std::optional<MaterialTag>(x < n / 2 ? 1 : 2); });
  jitter_inside(mesh, n, seed, amount, n / 2);
  set_patches(mesh, [&](const InterfaceTriangle& t, const Vec3& c) {
    return static_cast<std::uint16_t>(!t.other ? 0 : c.y() < n / 2 ? 1 : 2);
  });
  return mesh;
}

}  // namespace tetwright

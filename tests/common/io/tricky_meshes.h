// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>

#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Coordinates that are difficult to write: with 17 digits, huge, tiny, subnormal, minus zero.
inline std::vector<Vec3> tricky_points() {
  return {{0.1, 1.0 / 3, 0.1 + 0.2},
          {-1e308, 1.7976931348623157e308, 123456789012345678.0},
          {5e-324, -2.2250738585072014e-308, 1e-310},
          {-0.0, 0.0, 9007199254740993.0},
          {1e22, 1e23, 4.35}};
}

inline TetMesh tricky_tets() {
  TetMesh mesh;
  mesh.points = tricky_points();
  mesh.tets = {{0, 1, 2, 3}, {4, 3, 2, 1}, {1, 0, 4, 2}};
  mesh.materials = {2147483647, -2147483647 - 1, 0};
  mesh.material_names = {{0, "zero: a <b> & 'c'"}, {2147483647, "Z\xc3\xbcrich"}};
  return mesh;
}

/// tricky_tets() without coordinates that are too large for read_tet_mesh().
inline TetMesh tricky_measurable_tets() {
  TetMesh mesh = tricky_tets();
  mesh.points[1] = {-1e49, 1.7976931348623157e49, 123456789012345678.0};
  return mesh;
}

inline TriangleMesh tricky_surface() { return {tricky_points(), {{0, 1, 2}, {4, 3, 2}, {1, 0, 4}}}; }

inline bool same_bits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (std::bit_cast<std::uint64_t>(a[i][k]) != std::bit_cast<std::uint64_t>(b[i][k])) return false;
  return true;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The directions in which a point may move.
struct PointFreedom {
  int dimensions = 3;  ///< 0: it does not move
  /// Unit and orthogonal; the first `dimensions` count.
  std::array<Vec3, 3> directions{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
};

/// Moves points until all tets are positive and roughly regular: minimises a distortion that is finite for
/// inverted tets and grows without bound as its regularisation vanishes (Garanzha, Kaporin, Kudryavtseva,
/// Protais, Ray and Sokolov 2021, Foldover-free maps in 50 lines of code, section 2).
/// \param points any unit; changed
/// \param freedom by point
/// \return false if all tets are flat, or tets that are not positive are left; the points are then wherever
/// they have come
bool untangle(std::vector<Vec3>& points, std::span<const Tet> tets, std::span<const PointFreedom> freedom);

}  // namespace tetwright

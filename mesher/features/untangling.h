// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Moves points until all tets are positive and roughly regular: minimises a distortion that is finite for
/// inverted tets and grows without bound as its regularisation vanishes (Garanzha, Kaporin, Kudryavtseva,
/// Protais, Ray and Sokolov 2021, Foldover-free maps in 50 lines of code, section 2).
/// \param points any unit; changed
/// \param is_locked by point: does not move
/// \return false if all tets are flat, or tets that are not positive are left; the points are then wherever
/// they have come
bool untangle(std::vector<Vec3>& points, std::span<const Tet> tets, std::span<const std::uint8_t> is_locked);

}  // namespace tetwright

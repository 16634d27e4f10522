// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

namespace tetwright {

/// Half-width of the narrow band of signed distances, in voxels. Cut lattice edges around finest cells are at
/// most 2.6 cells long, so the distances at both ends are exact.
inline constexpr int level_set_band = 3;

/// Lowest grid point of a leaf. Distances are stored in OpenVDB's leaves of 8 x 8 x 8 grid points.
using LeafOrigin = std::array<int, 3>;
inline constexpr int leaf_side = 8;
inline constexpr int leaf_points = leaf_side * leaf_side * leaf_side;

/// True for a distance (voxels) that was clamped to the band.
inline bool outside_band(double distance) { return std::abs(distance) >= level_set_band; }

}  // namespace tetwright

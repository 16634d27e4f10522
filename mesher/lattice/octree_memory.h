// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tetwright {

/// Memory of the program and its libraries, bytes.
inline constexpr double program_bytes = 38e6;
/// Peak memory per leaf of an octree including its lattice points, bytes, before any tet exists.
inline constexpr double bytes_per_leaf = 150;

}  // namespace tetwright

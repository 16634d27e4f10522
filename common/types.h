// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>  // cross()
#include <array>
#include <cstdint>
#include <limits>

namespace tetwright {

/// A position or a direction, in input units unless a name says otherwise.
using Vec3 = Eigen::Vector3d;

/// Number of a point, triangle or tet in its array.
using Index = std::uint32_t;
inline constexpr Index no_index = std::numeric_limits<Index>::max();

using Triangle = std::array<Index, 3>;
using Tet = std::array<Index, 4>;

/// Integer that identifies a material: any value, returned unchanged. Outside has no tag.
using MaterialTag = std::int32_t;

/// Face i of a positive tet lies opposite its vertex i; its three vertices are listed so that the normal
/// points out.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> tet_faces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// The six edges of a tet.
inline constexpr std::array<std::array<std::uint8_t, 2>, 6> tet_edges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

}  // namespace tetwright

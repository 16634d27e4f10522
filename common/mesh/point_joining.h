// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The points of a piece of a mesh.
struct PiecePoints {
  std::span<const Vec3> points;
  std::span<const std::uint8_t> shared;  ///< by point: 1 if other pieces may have it, too
};

/// The points of all pieces, each once: in the order of the pieces and of their points.
struct JoinedPoints {
  std::size_t count = 0;
  std::vector<std::vector<Index>> numbers;  ///< by piece and point
};

/// Joins pieces at the shared points with equal coordinates.
/// \pre the points of a piece are distinct
/// \throws OutputError if the points of all pieces are too many for an Index
JoinedPoints join_points(std::span<const PiecePoints> pieces);

}  // namespace tetwright

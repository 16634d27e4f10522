// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The cells into which triangles divide space: the cell on each side of each triangle. A *cell* is connected
/// around edges; of surfaces that have no point in common each knows only its own cells.
struct SurfaceCells {
  /// Cell behind and in front of each triangle; the normal points to the front.
  std::vector<std::array<Index, 2>> sides;
  Index count = 0;
  /// Piece of each triangle: those connected by edges.
  std::vector<Index> piece;
};

/// Finds the cells by sorting the triangles around each edge by angle. Around an edge of one triangle its
/// front and back are the same cell.
/// \pre no two triangles have the same points, and none is flat
SurfaceCells find_cells(std::span<const Vec3> points, std::span<const Triangle> triangles);

}  // namespace tetwright

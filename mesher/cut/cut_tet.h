// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/types.h"
#include "mesher/domain/regions.h"

namespace tetwright {

/// A tet as it is to be cut: the regions of its four points (or on_interface) and the order of its
/// quadrilaterals' diagonals.
struct CutCase {
  std::array<RegionIndex, 4> regions;
  /// Of two points of one region, the diagonal starts at the one of lower rank. Different for each point.
  std::array<Index, 4> ranks;
};

/// A vertex of a piece as a set of the tet's corners, bit k for corner k: a corner itself, the cut of an
/// edge, the point of a face where three regions meet, or (all four) the point within the tet.
using PieceVertex = std::uint8_t;
struct Piece {
  std::array<PieceVertex, 4> vertices;
  RegionIndex region;
};
/// Four faces of six triangles each around a point within.
inline constexpr int max_pieces = 24;
using Pieces = std::array<Piece, max_pieces>;

/// A tet cut into pieces of one region each, all with the orientation of the whole.
///
/// One region: the tet itself. Two: a smaller tet and a prism, or two prisms; where two corners are on either
/// side, one quadrilateral lies within the tet, and `other_diagonal` says which way it is cut. Three and
/// four: the faces are cut as they would be for two, a face of three regions into six triangles around its
/// own point, and all are joined to a point within, or to the corner that is on an interface if there is one.
/// Writes to `pieces` and returns their number. A tet with all corners on interfaces does not exist.
int cut_tet(const CutCase& cut, bool other_diagonal, Pieces& pieces);

}  // namespace tetwright

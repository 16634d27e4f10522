// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "tetwright/mesher_input.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// How a tet is cut: the regions of its four points (or on_interface) and the order that determines the
/// diagonals of its quadrilaterals.
struct CutCase {
  std::array<RegionIndex, 4> regions;
  /// Between two points of one region the diagonal starts at the one of lower rank. Ranks differ.
  std::array<Index, 4> ranks;
};

/// A vertex of a piece as a set of corners of the tet, bit k for corner k: one corner itself, the cut of an
/// edge, the point in a face of three regions, or (all four) the point inside the tet.
using PieceVertex = std::uint8_t;
struct Piece {
  std::array<PieceVertex, 4> vertices;
  RegionIndex region;
};
/// Four faces of six triangles each, around an interior point.
inline constexpr int max_pieces = 24;
using Pieces = std::array<Piece, max_pieces>;

/// Cuts a tet into pieces of one region each, all oriented like the tet.
///
/// - One region: the tet itself.
/// - Two regions: a smaller tet and a prism, or two prisms. With two corners on either side, one
///   quadrilateral lies inside the tet, and `other_diagonal` chooses its diagonal.
/// - Three or four regions: a face of two regions is cut as above, a face of three regions into six triangles
///   around its own point. All triangles are joined to an interior point, or to the corner on an interface if
///   there is one.
///
/// \param pieces receives the pieces
/// \return the number of pieces
/// \pre not all corners are on interfaces
int cut_tet(const CutCase& cut, bool other_diagonal, Pieces& pieces);

}  // namespace tetwright

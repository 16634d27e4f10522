#pragma once

#include <vector>

#include "common/types.h"
#include "mesher/labelled_lattice.h"

namespace tetwright {

/// A tet mesh in grid coordinates.
struct CutMesh {
  std::vector<Vec3> points;
  std::vector<Tet> tets;
};

/// A tet as it is to be cut: the sides of its four points and the order of its quadrilaterals' diagonals.
struct CutCase {
  std::array<Side, 4> sides;
  /// Of two points inside, the diagonal starts at the one of lower rank. Different for each point.
  std::array<Index, 4> ranks;
};

/// A vertex of a piece: a corner of the tet (from == to) or the cut on the edge between two corners.
struct PieceVertex {
  int from, to;
};
using Piece = std::array<PieceVertex, 4>;

/// The inside of a cut tet as at most three tets, all with the orientation of the whole. Where two corners
/// are inside and two outside, one quadrilateral lies within the tet; `other_diagonal` says which way it is
/// cut. Writes to `pieces` and returns their number.
int cut_inside(const CutCase& cut, bool other_diagonal, std::array<Piece, 3>& pieces);

/// The smallest solid angle (steradians) among the pieces that a tet of the lattice leaves inside; larger
/// than any tet's if it leaves none.
double worst_inside_angle(const LabelledLattice& lattice, const Tet& tet);

/// The part of the lattice inside the interface: tets inside are kept, tets with points of both sides are
/// cut. A cut is made once per edge, by linear interpolation of the distances, and kept off the ends. Tets
/// stay in the order of the lattice, points are numbered in the order of their first use.
CutMesh cut_lattice(const LabelledLattice& lattice);

}  // namespace tetwright

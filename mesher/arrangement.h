#pragma once

#include "common/types.h"
#include "mesher/labelled_lattice.h"

namespace tetwright {

/// Whether a point may be put onto the interface without changing how inside and outside lie around it.
///
/// Around a point on the interface each side must show as one piece: the link of the point is a sphere of
/// triangles, and the link's points of either side must hang together by the link's edges and not be missing.
/// Then the interface passes through the point as one sheet. On top of it, no tet may have all four points on
/// the interface, and an edge or triangle whose points all came from one side must still belong to a tet that
/// has a point there, or a thin wall would lose its inside.
///
/// Looks at the point and at its neighbours that are on the interface already; reads sides only.
bool may_move_onto_interface(const LabelledLattice& lattice, const StarMap& stars, Index point);

}  // namespace tetwright

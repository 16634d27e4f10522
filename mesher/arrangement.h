#pragma once

#include <optional>

#include "common/types.h"
#include "mesher/labelled_lattice.h"

namespace tetwright {

/// The regions that would meet at a point if it were put onto the interface, or nothing where that would
/// change how the regions lie around it.
///
/// The link of a lattice point is a sphere of triangles. Around a point on an interface each region must show
/// as one disc of it: points that hang together by the link's edges (and, with three regions or more, enclose
/// nothing: Euler number 1). Then one sheet passes through the point, or one junction curve. All pure points
/// of the link must belong to the regions that meet at the point, now and later on, so that every tet around
/// it knows what to make of it. On top of it, no tet may have all four points on interfaces, and an edge or
/// triangle whose points all came from one region must still belong to a tet that has a pure point of it, or
/// a thin wall would lose its inside.
///
/// Looks at the point and at its neighbours that are on interfaces already (whose links reach two edges far);
/// reads regions only.
std::optional<RegionSet> regions_if_moved(const LabelledLattice& lattice, Index point);

/// The regions of the pure points of the closed star, or nothing if they are more than can meet at a point.
std::optional<RegionSet> pure_regions(const LabelledLattice& lattice, Index point);

}  // namespace tetwright

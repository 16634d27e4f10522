// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "mesher/lattice/labelled_lattice.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The regions that would meet at a lattice point moved onto the interface, or nothing if the move would
/// change the topology of the regions around it.
///
/// The link of a lattice point is a triangulated sphere. Around a point on an interface each region must
/// occupy one disc of the link: its points are connected by edges of the link and, with three regions or
/// more, enclose nothing (Euler number 1). Then exactly one interface or one junction curve passes through
/// the point. Every pure point of the link must belong, now and later, to one of the regions that meet at the
/// point, so that the region of every incident tet is defined. Moreover:
/// - no tet may have all four points on interfaces;
/// - an edge or triangle whose points all started in one region must still belong to a tet with a pure point
///   of that region; otherwise a thin wall would lose its interior.
///
/// For points on the box, the space beyond it counts as one more region.
///
/// Checks the point and its neighbours that are already on interfaces, so it reads regions up to two edges
/// away, and nothing else.
std::optional<RegionSet> regions_if_moved(const LabelledLattice& lattice, Index point);

/// The regions of the pure points of the closed star, or nothing if there are too many to meet at a point.
std::optional<RegionSet> pure_regions(const LabelledLattice& lattice, Index point);

}  // namespace tetwright

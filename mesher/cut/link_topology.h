// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/types.h"
#include "mesher/lattice/labelled_lattice.h"

namespace tetwright {

/// The regions that would meet at a point if it were moved onto the interface, or nothing if that would
/// change the topology of the regions around it.
///
/// The link of a lattice point is a triangulated sphere. Around a point on an interface each region must
/// occupy one disc of the link: its points are connected by edges of the link and, with three regions or
/// more, enclose nothing (Euler number 1). Then exactly one interface or one junction curve passes through
/// the point. All pure points of the link must belong to the regions that meet at the point, and keep doing
/// so, so that the region of every incident tet is defined. Besides, no tet may have all four points on
/// interfaces, and an edge or triangle whose points all came from one region must still belong to a tet with
/// a pure point of that region; otherwise a thin wall would lose its inside. What is beyond the box counts as
/// one more region around points on it.
///
/// Checks the point and those of its neighbours that are on interfaces already, whose links reach two edges
/// far. Reads regions only.
std::optional<RegionSet> regions_if_moved(const LabelledLattice& lattice, Index point);

/// The regions of the pure points of the closed star, or nothing if there are more than can meet at a point.
std::optional<RegionSet> pure_regions(const LabelledLattice& lattice, Index point);

}  // namespace tetwright

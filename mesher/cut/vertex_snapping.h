// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "mesher/domain/material_field.h"
#include "mesher/lattice/labelled_lattice.h"
#include "tetwright/progress.h"

namespace tetwright {

/// Numbers of lattice points, see snap_vertices().
struct SnapCounts {
  std::size_t candidates = 0;  ///< points that were too close to a cut of one of their edges
  std::size_t moved = 0;       ///< of the candidates, moved onto the interface
  std::size_t pushed = 0;  ///< of the candidates, moved away from it because they could not be moved onto it
};

/// Moves lattice points that are too close to a cut of one of their edges onto the interface, where cutting
/// would leave badly shaped tets (isosurface stuffing, Labelle & Shewchuk 2007, with different limits and
/// order: see CutTuning::Snapping).
///
/// Points nearest to the interface are moved first. A move is refused if it would give an incident lattice
/// tet a solid angle below 0.1 sr or change the topology of the regions around the point (link_topology.h).
/// All lattice tets stay positive. The result does not depend on the number of threads.
/// \param progress may be null
/// \throws Interrupted
SnapCounts snap_vertices(LabelledLattice& lattice, const MaterialField& field, Progress* progress);

}  // namespace tetwright

#pragma once

#include <cstddef>

#include "common/progress.h"
#include "mesher/labelled_lattice.h"
#include "mesher/material_field.h"

namespace tetwright {

/// What became of the points near the interface.
struct MoveCounts {
  std::size_t candidates = 0;  ///< points with a cut too near to them
  std::size_t moved = 0;       ///< now on the interface
  std::size_t pushed = 0;      ///< refused, and moved away from it instead
};

/// Moves lattice points that are so near a cut of one of their edges that cutting would leave poor tets onto
/// the interface (isosurface stuffing, Labelle & Shewchuk 2007; limits and order are our own, see the
/// constants). Nearest first; a move is refused where a lattice tet around the point would get a solid angle
/// below 0.1 sr or the arrangement of the sides would change. Every tet of the lattice stays positive.
/// The same result for any number of threads. Throws Interrupted.
MoveCounts move_points(LabelledLattice& lattice, const MaterialField& field, Progress* progress);

}  // namespace tetwright

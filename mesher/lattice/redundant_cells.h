// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesher/domain/material_field.h"
#include "mesher/domain/refinement_regions.h"
#include "tetwright/progress.h"

namespace tetwright {

/// Drops cells whose splitting would not show another topology of the regions.
///
/// If every edge that the tets of a cell can have, alone or beside smaller cells, has its midpoint in the
/// region of one of its ends, each region within such a tet is taken for a ball around the same vertices as
/// in the lattice of halved cells: the smaller cells would only move interfaces, which are computed exactly
/// on any edge. This compares points of the lattices, not what lies between them, so that it is no proof. A
/// cell is also kept if one of its points is the only one of its region among its neighbours
/// (label_lattice() would relabel it), or if it contains a kept cell of a finer level.
///
/// Tests one level after another, from the finest one: O(cells), about 40 field evaluations for each. The
/// result does not depend on the number of threads.
///
/// \param finer cells to be split; receives those kept. Levels that become empty at the fine end are removed.
/// \param field unrefined
/// \param exempt number of levels, from the finest one, whose cells are all kept
/// \param largest edge of the largest cells that may be dropped, lattice units. Cells larger than a voxel
///   would cut off a part of thin labels.
/// \param progress may be null
/// \throws Interrupted
void drop_redundant_cells(RefinementRegions& finer, const MaterialField& field, int exempt, double largest,
                          const Progress* progress);

}  // namespace tetwright

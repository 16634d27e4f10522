// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesher/domain/material_field.h"
#include "mesher/domain/refinement_regions.h"
#include "tetwright/progress.h"

namespace tetwright {

/// Drops the cells whose splitting would not change the topology of any region.
///
/// The lattice of halved cells has the points of the lattice of whole ones and the midpoints of its edges. If
/// every midpoint is in the region of an end of its edge, each region within a tet remains a ball around the
/// same vertices, and the same pairs of regions meet: the smaller cells would only move interfaces, which are
/// computed exactly on any edge. A cell is kept if an edge of its tets is not of that kind, if one of its
/// points is the only one of its region among its neighbours (label_lattice() would relabel it), or if it
/// contains a kept cell of a finer level.
///
/// Tests one level after another, from the finest one: O(cells), about 15 field evaluations for each. The
/// result does not depend on the number of threads.
///
/// \param finer cells to be split; receives those kept. Levels that become empty at the fine end are removed.
/// \param field unrefined
/// \param exempt number of levels, from the finest one, whose cells are all kept
/// \param progress may be null
/// \throws Interrupted
void drop_redundant_cells(RefinementRegions& finer, const MaterialField& field, int exempt,
                          const Progress* progress);

}  // namespace tetwright

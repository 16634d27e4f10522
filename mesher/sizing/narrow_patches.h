// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mesher/domain/grid_frame.h"
#include "mesher/domain/refinement_regions.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Cells to be split where patches are narrow or a region is requested.
struct NarrowPatches {
  RefinementRegions finer;
  std::vector<MortonKey> voxels;  ///< voxels with smaller cells, ascending: their distances must be exact
};

/// Finds where a patch is too narrow for the cells to resolve both its creases, and halves cells there until
/// two span its width. Creases that converge at a corner do not count as narrow.
/// \param max_depth max number of halvings
/// \param max_tets approximate max number of dense tets to add; if it is exceeded, the depth is reduced
///   everywhere
NarrowPatches find_narrow_patches(const RepairedSurface& surface, const SurfacePatches& patches,
                                  const GridFrame& frame, int max_depth, double max_tets);

/// Halves cells around requested points, input units; otherwise as find_narrow_patches().
NarrowPatches cells_around(const std::vector<RefinementRegion>& asked, const GridFrame& frame, int max_depth,
                           double max_tets);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/features/surface_patches.h"
#include "mesher/domain/grid_frame.h"
#include "mesher/domain/refinement_region.h"
#include "mesher/domain/refinement_regions.h"
#include "mesher/input/surface_repair.h"

namespace tetwright {

/// Cells to be split where patches are narrow or a region is requested.
struct NarrowPatches {
  RefinementRegions finer;
  std::vector<MortonKey> voxels;  ///< voxels with smaller cells, ascending: their distances must be exact
};

/// Finds where a patch is too narrow for the cells to resolve both its creases, and halves cells there until
/// two span its width. Near a corner, where creases meet, a patch ends and is not narrow.
/// \param max_depth halvings at most
/// \param max_tets dense tets that this may add, approximately; if it adds more, the depth is reduced
///   everywhere
NarrowPatches find_narrow_patches(const RepairedSurface& surface, const SurfacePatches& patches,
                                  const GridFrame& frame, int max_depth, double max_tets);

/// Halves cells around requested points, input units; otherwise as find_narrow_patches().
NarrowPatches cells_around(const std::vector<RefinementRegion>& asked, const GridFrame& frame, int max_depth,
                           double max_tets);

}  // namespace tetwright

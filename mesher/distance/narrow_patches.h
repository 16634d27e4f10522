// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/features/surface_patches.h"
#include "mesher/domain/grid_frame.h"
#include "mesher/domain/refinement_region.h"
#include "mesher/domain/refinement_regions.h"
#include "mesher/input/surface_repair.h"

namespace tetwright {

/// Where patches are narrow, or cells smaller for other reasons.
struct NarrowPatches {
  RefinementRegions finer;
  std::vector<MortonKey> voxels;  ///< of which cells are smaller, ascending: their distances must be exact
};

/// Where a patch is so narrow that cells would not show both its creases: cells there are halved until its
/// width has two of them, at most `max_depth` times and as long as that adds no more than about `max_tets`
/// dense tets (else nowhere so deep). Near a corner, where creases meet, a patch ends and is not narrow.
NarrowPatches find_narrow_patches(const RepairedSurface& surface, const SurfacePatches& patches,
                                  const GridFrame& frame, int max_depth, double max_tets);

/// The same around places that are asked for, input units.
NarrowPatches cells_around(const std::vector<RefinementRegion>& asked, const GridFrame& frame, int max_depth,
                           double max_tets);

}  // namespace tetwright

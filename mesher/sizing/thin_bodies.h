// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mesher/sizing/narrow_patches.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// Twice the volume by the area, input units: the thickness of a plate, or the radius of a rod.
double mean_thickness(const RepairedSurface& surface);

/// Cells along bodies.
struct BodySizes {
  NarrowPatches cells;        ///< to be split
  std::vector<double> sizes;  ///< of the cells at each body, input units
};

/// Halves cells along the surfaces of bodies in a volume that are thin, or small and round, for the cells of
/// its labels.
/// \param asked points around which cells are halved as well, input units
/// \param max_depth, max_tets as for find_narrow_patches()
BodySizes cells_of_thin_bodies(const MesherInput& bodies, const GridFrame& voxels,
                               std::vector<RefinementRegion> asked, int max_depth, double max_tets);

}  // namespace tetwright

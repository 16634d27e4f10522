// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mesher/sizing/narrow_patches.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// Twice the volume by the area, input units: the thickness of a plate, or the radius of a rod.
double mean_thickness(const RepairedSurface& surface);

/// Halves cells along the surfaces of bodies in a volume if one of them is thin for the cells of its labels:
/// along all of them as often as the thinnest needs.
/// \param asked points around which cells are halved as well, input units
/// \param max_depth, max_tets as for find_narrow_patches()
NarrowPatches cells_of_thin_bodies(const MesherInput& bodies, const GridFrame& voxels,
                                   std::vector<RefinementRegion> asked, int max_depth, double max_tets);

}  // namespace tetwright

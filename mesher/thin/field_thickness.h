// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mesher/domain/material_field.h"
#include "mesher/domain/refinement_regions.h"

namespace tetwright {

/// Sheets between two level sets (layers, gaps between nested surfaces) thinner than one and a half cells. A
/// lattice of voxel-sized cells would tear them, although the level sets represent them exactly.
struct ThinSheets {
  RefinementRegions finer;
  std::vector<ThinPart> too_thin;  ///< thinner than one and a half of the smallest possible cells
};

/// Tests the voxels that contain an interface. Costs nothing for a single level set.
/// \pre `field` is not refined
ThinSheets find_thin_sheets(const MaterialField& field, const std::vector<MortonKey>& interface_voxels);

/// The regions, including the outside, that are somewhere thinner than two voxels without being such a sheet,
/// by number. Their topology may differ from the input's there.
/// \pre `field` is not refined
std::vector<ThinPart> find_thin_parts(const MaterialField& field,
                                      const std::vector<MortonKey>& interface_voxels);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mesher/distance/material_field.h"
#include "mesher/domain/refinement_regions.h"

namespace tetwright {

/// Sheets between two level sets (layers, gaps between nested surfaces) that are thinner than one and a half
/// cells. They would tear in a lattice of voxels, although the level sets represent them exactly.
struct ThinSheets {
  RefinementRegions finer;
  std::vector<ThinPart> too_thin;  ///< thinner than one and a half of the smallest possible cells
};

/// Tests the voxels that contain an interface. `field` must not be refined. Free for a single level set.
ThinSheets find_thin_sheets(const MaterialField& field, const std::vector<MortonKey>& interface_voxels);

/// Regions, including the outside, that are thinner than two voxels in places that are no such sheets, by
/// number. Their topology may differ from the input's there. `field` must not be refined.
std::vector<ThinPart> find_thin_parts(const MaterialField& field,
                                      const std::vector<MortonKey>& interface_voxels);

}  // namespace tetwright

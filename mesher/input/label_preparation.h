// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// Sets the file and the grid of a volume; a finding says that its spacing is assumed.
void set_grid(const LabelGrid& grid, const std::string& file, LabelInput& result);

/// Merges small islands, drops materials that are lost with them and counts the parts of all regions.
/// \param result its regions, materials and their voxels, and its image; receives the rest
/// \param none_outside message if no voxel is outside
/// \param progress may be null
/// \throws InputError, NothingToMeshError and Interrupted as make_label_input() does
void prepare_regions(LabelInput& result, std::size_t min_voxels, const std::string& none_outside,
                     const Progress* progress);

}  // namespace tetwright

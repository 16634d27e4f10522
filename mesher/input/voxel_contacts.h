// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tetwright/progress.h"
#include "tetwright/region_grid.h"

namespace tetwright {

/// Two regions with voxels that touch.
struct VoxelContact {
  RegionIndex first = 0, second = 0;  ///< first < second
  std::uint64_t faces = 0;            ///< that they share; 0 if they only touch in edges and corners
  std::uint64_t voxel = 0;            ///< the lowest voxel of either region with such a neighbour
};

/// Finds the pairs of regions with voxels that touch at least in a corner, ascending. Parallel; the result
/// does not depend on the number of threads. \param progress may be null \throws Interrupted
std::vector<VoxelContact> voxel_contacts(const RegionGrid& regions, const Progress* progress);

}  // namespace tetwright

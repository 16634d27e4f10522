// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "common/geometry/morton.h"
#include "tetwright/mesher_input.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Cells that the octree must split in addition to those that the interface requires.
struct RefinementRegions {
  int refinement = 0;  ///< levels below a voxel
  /// The cells to be split: one ascending list for each level of a lattice refined that far, and possibly one
  /// for cells of two voxels.
  std::vector<std::vector<MortonKey>> cells;
  int coarsest_interface_level = 2;  ///< see OctreeOptions
};

/// A region that is too thin for its cells somewhere.
struct ThinPart {
  RegionIndex region;
  std::size_t places;  ///< number of voxels, or of finest cells for a sheet between two level sets
  Vec3 first;          ///< position of one of them, voxels
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
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

  /// Whether the cell around a point must be split.
  /// \param point voxels, not below 0
  /// \param depth halvings of a voxel that give the cell
  bool splits(const Vec3& point, int depth) const {
    if (depth >= refinement) return false;
    const Vec3 cell = point * std::ldexp(1, depth);
    const std::vector<MortonKey>& level = cells[static_cast<std::size_t>(refinement - depth)];
    return std::binary_search(
        level.begin(), level.end(),
        morton_encode(static_cast<int>(cell[0]), static_cast<int>(cell[1]), static_cast<int>(cell[2])));
  }
};

/// A region that is too thin for its cells somewhere.
struct ThinPart {
  RegionIndex region;
  std::size_t places;  ///< number of voxels, or of finest cells for a sheet between two level sets
  Vec3 first;          ///< position of one of them, voxels
};

}  // namespace tetwright

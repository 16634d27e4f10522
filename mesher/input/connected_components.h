// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// An island that was merged into another region.
struct MergedIsland {
  Index voxel = 0;   ///< its lowest voxel
  Index voxels = 0;  ///< number of its voxels before any merge
  RegionIndex from = 0, to = 0;
};

struct IslandMerging {
  std::size_t islands = 0;    ///< number in the volume before merging; 0 if not counted
  bool none_reaches = false;  ///< true if no island has `min_voxels` voxels, so nothing was merged
  /// By ascending voxel. Omits islands that ended up in their own region again.
  std::vector<MergedIsland> merged;
};

/// Merges islands (face-connected voxels of one region) of fewer than `min_voxels` voxels into the region
/// with which they share most voxel faces; ties go to the smallest region number. The smallest island is
/// merged first; ties go to the lowest voxel. It is united with all islands of that region that it touches,
/// and from then on the size of the union counts.
///
/// Voxel faces on the border of the volume do not count. The outside is treated like other regions, but its
/// islands at the border of the volume continue beyond it and are never small. Axes of a single voxel have no
/// border.
///
/// Takes twelve bytes for each run of equal voxels along the first axis, and O(voxels) time. The result does
/// not depend on the number of threads.
/// \param regions first axis fastest, fewer than 2^32 - 1 voxels
/// \param progress may be null
/// \throws Interrupted
IslandMerging merge_small_islands(std::vector<RegionIndex>& regions, const std::array<int, 3>& size,
                                  std::size_t min_voxels, const Progress* progress);

/// Numbers of parts of a region, connected by voxel faces or touching at least at a corner. Voxels do not
/// determine whether parts that touch are connected, so a smooth region may have any number of parts between
/// the two.
struct RegionParts {
  std::size_t touching = 0, by_faces = 0;
  Index smallest = no_index;  ///< lowest voxel of the smallest part by faces, if any
};

/// Counts the parts of regions 0 to `count` - 1. For the outside, counts only parts that neither reach the
/// border of the volume nor touch one that does; in a slice all parts of the outside reach it. Memory and
/// time as for merge_small_islands().
/// \throws Interrupted
std::vector<RegionParts> count_parts(std::vector<RegionIndex>& regions, const std::array<int, 3>& size,
                                     std::size_t count, const Progress* progress);

}  // namespace tetwright

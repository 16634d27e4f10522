// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "common/progress.h"
#include "common/types.h"
#include "mesher/domain/regions.h"

namespace tetwright {

/// An island that was merged into another region.
struct MergedIsland {
  Index voxel = 0;   ///< its voxel of the lowest index
  Index voxels = 0;  ///< number of its voxels before anything was merged
  RegionIndex from = 0, to = 0;
};

struct IslandMerging {
  std::size_t islands = 0;    ///< number in the volume before merging; 0 if not counted
  bool none_reaches = false;  ///< true if no island has `min_voxels` voxels, so nothing was merged
  /// By ascending voxel, without islands that ended up in their own region again.
  std::vector<MergedIsland> merged;
};

/// Merges islands (face-connected voxels of one region) of fewer than `min_voxels` voxels into the region
/// with which they share most voxel faces; ties go to the smallest region number. The smallest island is
/// merged first, of equal ones the one with the lowest voxel. It is united with all islands of that region
/// that it touches, and the size of the union counts from then on. The border of the volume shares no faces.
/// The outside is treated like other regions, but its islands at the border of the volume continue beyond it
/// and are never small. Axes of a single voxel have no border.
///
/// `regions`: the first axis fastest, fewer than 2^32 - 1 voxels. Takes twelve bytes for each run of equal
/// voxels along the first axis, and O(voxels) time. The same result for any number of threads. Throws
/// Interrupted.
IslandMerging merge_small_islands(std::vector<RegionIndex>& regions, const std::array<int, 3>& size,
                                  std::size_t min_voxels, const Progress* progress);

/// Parts of a region: those connected by faces of voxels, and those that touch at least in a corner. Voxels
/// do not say which of them belong together: a smooth region has as many parts or a number between.
struct RegionParts {
  std::size_t touching = 0, by_faces = 0;
  Index smallest = no_index;  ///< the lowest voxel of the smallest part by faces, if there is any
};

/// The parts of regions 0 to `count` - 1; of the outside those that do not reach the border of the volume
/// (nor touch one that does), which all of a slice does. Throws Interrupted; memory and time as for
/// merge_small_islands().
std::vector<RegionParts> count_parts(std::vector<RegionIndex>& regions, const std::array<int, 3>& size,
                                     std::size_t count, const Progress* progress);

}  // namespace tetwright

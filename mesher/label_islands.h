#pragma once

#include <array>
#include <vector>

#include "common/progress.h"
#include "common/types.h"
#include "mesher/regions.h"

namespace tetwright {

/// An island that was merged into another region.
struct MergedIsland {
  Index voxel = 0;   ///< its lowest
  Index voxels = 0;  ///< as many as it had at first
  RegionIndex from = 0, to = 0;
};

struct IslandMerging {
  std::size_t islands = 0;    ///< of the whole volume, before; 0 where none were sought
  bool none_reaches = false;  ///< no island has `min_voxels` voxels, so that nothing was merged
  std::vector<MergedIsland>
      merged;  ///< by ascending voxel; those that end up in the region they were of are not listed
};

/// Merges islands (voxels of a region that hang together by faces) of fewer than `min_voxels` voxels into the
/// region that they share most voxel faces with, of equal ones the smallest: the smallest island first, of
/// equal ones that with the lowest voxel. It becomes one with all islands of that region that it touches, and
/// they are counted anew. Beyond the volume there is nothing to share a face with. All regions are treated
/// alike, outside too.
///
/// `regions`: the first axis fastest, fewer than 2^32 - 1 voxels. Twelve bytes for each run of equal voxels
/// along the first axis; O(voxels) and a few steps for each voxel of small islands. The same for any number
/// of threads. Throws Interrupted.
IslandMerging merge_small_islands(std::vector<RegionIndex>& regions, const std::array<int, 3>& size,
                                  std::size_t min_voxels, const Progress* progress);

}  // namespace tetwright

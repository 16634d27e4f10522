// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// An island that was merged into another region.
struct MergedIsland {
  std::uint64_t voxel = 0;  ///< its lowest voxel
  Index voxels = 0;         ///< number of its voxels before any merge
  RegionIndex from = 0, to = 0;
};

/// Two islands of one region, neither of them small, that the merging of a third one joined.
struct JoinedIslands {
  RegionIndex region = 0;
  std::uint64_t voxel = 0;  ///< lowest voxel of the third one
};

struct IslandMerging {
  /// Runs of equal voxels along the first axis. With more than 2^32 - 2 of them nothing was merged or
  /// counted.
  std::uint64_t runs = 0;
  std::size_t islands = 0;    ///< number in the volume before merging; 0 if not counted
  bool none_reaches = false;  ///< true if no island has `min_voxels` voxels, so nothing was merged
  /// By ascending voxel. Omits islands that ended up in their own region again.
  std::vector<MergedIsland> merged;
  std::vector<JoinedIslands> joined;
};

/// Merges islands (voxels of one region that touch at least in a corner) of fewer than `min_voxels` voxels
/// into the region with which they share most voxel faces; ties go to the smallest region number. The
/// smallest island is merged first; ties go to the lowest voxel. It is united with all islands of that region
/// that it touches, and from then on the size of the union counts. Voxels of diagonal layers of one voxel
/// touch in edges and corners alone, so that with islands by faces such layers would fall apart and be
/// merged.
///
/// Voxel faces on the border of the volume do not count. The outside is treated like other regions, but its
/// islands at the border of the volume continue beyond it and are never small. Axes of a single voxel have no
/// border.
///
/// Takes 18 bytes for each run of equal voxels along the first axis, up to 50 where all islands are small,
/// and O(voxels) time. The result does not
/// depend on the number of threads.
/// \param min_voxels counts as 2^32 - 1 if it is more
/// \param progress may be null
/// \throws Interrupted
IslandMerging merge_small_islands(RegionGrid& regions, std::size_t min_voxels, const Progress* progress);

/// No voxel.
inline constexpr std::uint64_t no_voxel = UINT64_MAX;

/// Numbers of parts of a region, connected by voxel faces or touching at least at a corner. Voxels do not
/// determine whether parts that touch are connected, so a smooth region may have any number of parts between
/// the two.
struct RegionParts {
  std::size_t touching = 0, by_faces = 0;
  /// Lowest voxel of the smallest part by faces, if any; parts of 2^32 - 1 voxels and more count as equal.
  std::uint64_t smallest = no_voxel;
};

/// Counts the parts of regions 0 to `count` - 1. For the outside, counts only parts that neither reach the
/// border of the volume nor touch one that does; in a slice all parts of the outside reach it. Memory and
/// time as for merge_small_islands().
/// \return nothing if there are more than 2^32 - 2 runs of equal voxels
/// \throws Interrupted
std::vector<RegionParts> count_parts(const RegionGrid& regions, std::size_t count, const Progress* progress);

}  // namespace tetwright

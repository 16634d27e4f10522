#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/morton.h"
#include "common/progress.h"
#include "mesher/material_field.h"

namespace tetwright {

/// A linear octree over the box of a frame: its leaves, sorted. A leaf of level l is a cube of 2^l finest
/// cells (lattice units) to an edge. Leaves that share a face or an edge differ by at most one level; across
/// corners they may differ by more.
struct Octree {
  struct Leaf {
    MortonKey key;  ///< of the lower corner, in finest cells
    int level;
  };

  std::array<int, 3> cells;           ///< the box, in finest cells; see GridFrame
  int root_level;                     ///< level of the largest leaves there can be
  std::vector<std::uint64_t> packed;  ///< key << 5 | level, ascending

  std::size_t size() const { return packed.size(); }
  Leaf leaf(std::size_t i) const { return {packed[i] >> 5, static_cast<int>(packed[i] & 31)}; }
  /// The number of the leaf that holds the finest cell with this lower corner, which is in the box. Fast
  /// where it is not far from the number `hint`.
  std::size_t find(MortonKey finest_cell, std::size_t hint = 0) const;
};

/// Says which cells of a level (keys >> 3 * level) have to be split, given the ascending list of those that
/// already are; asked for levels 1 and up, in that order. Need be neither sorted nor unique.
using SplitCells = std::function<std::vector<MortonKey>(int level, const std::vector<MortonKey>& already)>;

/// The coarsest octree in which all cells that `split` names are split and that is balanced across faces and
/// edges (a linear octree's ripple in one sweep from the finest level up).
Octree build_octree(const std::array<int, 3>& cells, int root_level, const SplitCells& split);

struct OctreeOptions {
  bool uniform = false;      ///< cells of one voxel everywhere (the frame's root level must be 0)
  double adaptivity = 0.05;  ///< how far a coarse cell may misplace an interface, in voxels
  /// The largest cells that may hold an interface, in levels above a voxel: their tests read every corner of
  /// voxels in the cell, and their own corners must mostly be within the narrow band.
  int coarsest_interface_level = 2;
};

/// The octree for a field: cells of one voxel at interfaces, save where linear interpolation over a coarser
/// cell does as well, and cells growing away from them. `interface_voxels` are the field's; cells listed in
/// `thin`, by level, are split further.
/// Throws Interrupted.
Octree build_octree(const MaterialField& field, const OctreeOptions& options,
                    std::vector<MortonKey> interface_voxels, const std::vector<std::vector<MortonKey>>& thin,
                    Progress* progress);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "common/geometry/morton.h"
#include "mesher/domain/grid_frame.h"
#include "mesher/domain/material_field.h"
#include "tetwright/progress.h"

namespace tetwright {

/// A linear octree over the box of a frame, or over a part of it, the window: its sorted leaves. A leaf of
/// level l is a cube with an edge of 2^l finest cells (lattice units). Leaves that share a face or an edge
/// differ by at most one level; across corners they may differ by more.
struct Octree {
  struct Leaf {
    MortonKey key;  ///< of the lower corner, in finest cells
    int level;
  };

  std::array<int, 3> cells;           ///< the box, in finest cells; see GridFrame
  CellBox window;                     ///< the part of it that leaves fill, in finest cells
  int root_level;                     ///< maximum level of a leaf
  std::vector<std::uint64_t> packed;  ///< key << 5 | level, ascending
  /// Leaves of `packed` that cells beyond the window might split, ascending: all others in the window
  /// are leaves of the whole box's octree.
  std::vector<std::uint64_t> uncertain;
  CellBox border{};  ///< see GridFrame; leaves on both sides of its planes are mirror images of each other

  std::size_t size() const { return packed.size(); }
  Leaf leaf(std::size_t i) const { return {packed[i] >> 5, static_cast<int>(packed[i] & 31)}; }
  /// The leaves in a part of the window that consists of root cells; nothing if the whole box's octree may
  /// have others there.
  std::optional<Octree> part(const CellBox& box) const;
  /// The index of the leaf that contains the finest cell with this lower corner, which must be in the window.
  /// Fast if it is close to `hint`.
  std::size_t find(MortonKey finest_cell, std::size_t hint = 0) const;
};

/// Returns the cells of a level (keys >> 3 * level) that must be split, given the ascending list of cells
/// already split. Called for levels 1 and up, in this order. The result need be neither sorted nor unique.
using CellsToSplit = std::function<std::vector<MortonKey>(int level, const std::vector<MortonKey>& already)>;

/// The coarsest octree that is balanced across faces and edges and in which all cells returned by `split` are
/// split. Built in one sweep from the finest level up. Its window is the whole box.
Octree build_octree(const std::array<int, 3>& cells, int root_level, const CellsToSplit& split);

struct OctreeOptions {
  bool uniform = false;      ///< cells of one voxel everywhere (the frame's root level must be 0)
  double adaptivity = 0.05;  ///< the error that a coarse cell may have at an interface, voxels
  /// Level, above that of a voxel, of the largest cells that may contain an interface. Larger ones would be
  /// costly to test, since the test reads all voxel corners in a cell, and their own corners would mostly be
  /// outside the narrow band.
  int coarsest_interface_level = 2;
};

/// The octree for a field, restricted to leaves within the frame's box: cells of one voxel at interfaces,
/// except where trilinear interpolation over a coarser cell is accurate enough, and larger cells away from
/// them.
/// \param interface_voxels of the field, at least those in the window
/// \param thin by level: cells that are split further, at least those in the window
/// \param progress may be null
/// \param window whole root cells of the frame, finest cells; null: all. Not with OctreeOptions::uniform
/// \throws Interrupted
Octree build_octree(const MaterialField& field, const OctreeOptions& options,
                    std::vector<MortonKey> interface_voxels, const std::vector<std::vector<MortonKey>>& thin,
                    Progress* progress, const CellBox* window = nullptr);

}  // namespace tetwright

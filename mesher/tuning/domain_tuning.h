// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tetwright {

/// Frames of voxels and lattices; mesher/README.md, Tuned numbers, explains the terms.
struct DomainTuning {
  struct Frames {
    /// Margin between the surface's bounding box and the box of the octree, cells. Points that may move and
    /// their stars reach two cells from the surface; the third cell keeps the faces of the box away from
    /// them.
    static constexpr int margin = 3;
    /// Max level of root cells in segmented volumes. A cell that is split affects others up to twice its size
    /// away; with 2^3 voxels, 16 voxels around a part of a volume determine its octree. Larger cells would
    /// save three tets of a hundred in a solid body of 256^3 voxels.
    static constexpr int max_volume_root = 3;
    /// Cells along the longest side. Fewer hardly resolve a shape; a ball at the max resolution has 1.5e9
    /// dense tets, nearly as many as can be numbered.
    static constexpr int min_resolution = 4, max_resolution = 4096;
    /// Max cells along a side after all halvings, as make_grid_frame() requires.
    static constexpr double max_cells = 1 << 18;
    /// Coordinates must resolve this fraction of a finest cell, or rounding them could invert a thin tet.
    static constexpr double share_of_rounding = 0x1p-20;
    /// Max tets of a mesh. Indices have 32 bits, and a lattice has more tets than its mesh.
    static constexpr double max_tets = 2e9;
  };

  struct Refinement {
    /// Max levels of cells below a voxel for sheets between surfaces and for thin labels (the guide,
    /// Regions): each level multiplies the tets along a sheet by four.
    static constexpr int max_levels = 3;
  };
};

}  // namespace tetwright

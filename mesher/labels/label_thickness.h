// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mesher/domain/grid_frame.h"
#include "mesher/domain/refinement_regions.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// Cells of a frame that must be split because a label, or the outside, is thinner than two of them.
struct ThinLabels {
  RefinementRegions finer;
  int island_levels = 0;  ///< number of levels of `finer`, from the finest one, that islands alone need
  /// Parts still thinner than two of the smallest cells. Counts are of voxels of the volume; positions are
  /// voxel centres in cells of the frame.
  std::vector<ThinPart> too_thin;
};

/// Memory of a search for thin labels, bytes.
double thin_search_bytes(const LabelInput& labels);

/// Finds the voxels that are in no box of one region, nor beside a voxel of their region that is. The outside
/// continues beyond the volume. Parallel.
/// \param sides of the box, voxels
/// \param slab_bytes memory for as many slices as it holds, but at least for some (LabelTuning::Thickness);
///   the result does not depend on it
/// \param progress may be null
/// \return numbers of voxels, the first axis fastest, ascending
/// \throws Interrupted
std::vector<std::size_t> thin_voxels(const LabelInput& labels, const VoxelIndex& sides,
                                     std::size_t slab_bytes, const Progress* progress);

/// Finds the voxels where labels are thin. A label is thick at a voxel if a cube of two cells that contains
/// the voxel fits into the label (an opening, Serra 1982), or the voxel is adjacent to such a cube. Elsewhere
/// the cells around the voxel are halved until the cube fits or they have an eighth of their size. Islands of
/// fewer than eight voxels, if there are few, get eight cells per voxel. Also determines how large cells at
/// other interfaces may be. Needs some 256 MB temporarily, or four bytes for each voxel if that is less; more
/// for slices of millions of voxels.
/// \param frame from label_frame()
/// \param progress may be null
/// \throws Interrupted
ThinLabels find_thin_labels(const LabelInput& labels, const GridFrame& frame, const Progress* progress);

/// Numbers of cells to be split whose centre is in a label, and of those whose centre is outside.
struct ThinCells {
  double inside = 0, outside = 0;
};
ThinCells count_thin_cells(const LabelInput& labels, const GridFrame& frame, const RefinementRegions& finer);

/// Edge of the largest cells that drop_redundant_cells() may drop, a voxel, lattice units.
double largest_redundant_cell(const LabelInput& labels, const GridFrame& frame);

}  // namespace tetwright

#pragma once

#include <vector>

#include "mesher/field_mesher.h"
#include "mesher/label_input.h"
#include "mesher/thin_parts.h"

namespace tetwright {

/// Where cells have to be smaller than those of a frame (label_frame()'s) because a label, or outside, is
/// thinner than two of them.
struct ThinLabels {
  FinerCells finer;
  std::vector<ThinPart> too_thin;  ///< still thinner than two of the smallest cells: voxels, places in voxels
};

/// Where a cube of two cells fits into a label around a voxel, the label is thick there (an opening, Serra
/// 1982), and so it is beside such a cube; elsewhere the cells around the voxel are halved, until it fits or
/// they are 1/2^most_refinement. Islands of fewer than eight voxels, where these are few, take eight cells to
/// a voxel. Cells of up to about a voxel that could be larger than the frame's where an interface is plain
/// are split by the same rule. Two bytes for each voxel while it works. Throws Interrupted.
ThinLabels find_thin_labels(const PreparedLabels& labels, const GridFrame& frame, const Progress* progress);

}  // namespace tetwright

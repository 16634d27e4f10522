// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesher/labels/label_bricks.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// Distances of the regions of an image, negative inside.
///
/// Half the difference of two regions' distances is half the difference of their potentials
/// (MaterialImage) divided by the mean slope of interfaces nearby, which varies slowly. So it is zero where
/// the trilinear image has the interface, up to the small change of that slope within a voxel, and its own
/// slope is about 1 there. Away from interfaces, where the values of an image say little about the distance,
/// it is at least the distance from voxels of other regions. Distances of more than 17 voxels, where the
/// contrast of an edge is many times the mean nearby, are clamped.
///
/// Where LabelInput::regions differs from the image, since islands were merged, it prevails at voxel centres.
/// Parallel; the result does not depend on the number of threads.
/// \pre labels.image is not null and has the size of the volume
/// \throws Interrupted
LabelBricks make_image_bricks(const LabelInput& labels, const Progress* progress);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/features/surface_patches.h"
#include "mesher/input/label_input.h"

namespace tetwright {

/// The edges of the volume's box along which two cuts of a label meet, except for the last voxel at each end,
/// and the corners of the box that a label fills; input units.
CreaseCurves border_creases(const LabelInput& labels);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/features/surface_patches.h"
#include "mesher/input/label_input.h"

namespace tetwright {

/// The edges of the volume's box along which two cuts of a label meet, up to a voxel from where it ends, and
/// the corners that a label fills; input units.
CreaseCurves border_creases(const LabelInput& labels);

}  // namespace tetwright

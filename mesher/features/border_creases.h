// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/mesher_input.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// The parts of the box edges of a volume that are filled by a label, except for the last voxel at each end,
/// and the corners of the box that a label fills; input units.
CreaseCurves border_creases(const LabelInput& labels);

}  // namespace tetwright

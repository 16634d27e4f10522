// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesher/input/label_input.h"

namespace tetwright {

/// Areas of the faces between voxels of different regions, input units squared: `outer` between a material
/// and the outside, also at the border of the volume, `inner` between two materials.
struct FaceAreas {
  double outer = 0, inner = 0;
};

/// Runs in parallel; the result does not depend on the number of threads.
FaceAreas face_areas(const LabelInput& labels);

}  // namespace tetwright

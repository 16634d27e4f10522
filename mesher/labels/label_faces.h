// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "tetwright/mesher_input.h"

namespace tetwright {

/// Areas of the faces between voxels of different regions, input units squared: `outer` between a material
/// and the outside, also at the border of the volume, `inner` between two materials.
struct FaceAreas {
  double outer = 0, inner = 0;
};

/// Runs in parallel; the result does not depend on the number of threads.
FaceAreas face_areas(const LabelInput& labels);

/// The volume is divided into boxes of this many voxels along each axis: the largest share of the faces
/// between voxels of different regions that one of them has; 1 if there are none. Parallel.
double largest_share_of_faces(const LabelInput& labels, const std::array<double, 3>& box);

}  // namespace tetwright

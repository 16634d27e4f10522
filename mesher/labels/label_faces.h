// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "tetwright/mesher_input.h"

namespace tetwright {

/// Areas of the faces between voxels of different regions, input units squared: `outer` between a material
/// and the outside, also at the border of the volume, `inner` between two materials.
struct FaceAreas {
  double outer = 0, inner = 0;
  double faces = 0;  ///< number of all
};

/// Runs in parallel; the result does not depend on the number of threads.
FaceAreas face_areas(const LabelInput& labels);

/// Numbers of faces between voxels of different regions in the boxes into which a volume is divided.
struct BoxFaces {
  std::array<std::size_t, 3> boxes{};  ///< along each axis
  std::vector<std::size_t> counts;     ///< by box, the first axis fastest

  /// Share of all faces that are in the box with most of them; 1 if there are none.
  double largest_share() const;
};

/// Parallel.
/// \param box voxels along each axis
/// \param offset by which the first box begins before the volume, boxes
BoxFaces faces_of_boxes(const LabelInput& labels, const std::array<double, 3>& box, double offset = 0);

}  // namespace tetwright

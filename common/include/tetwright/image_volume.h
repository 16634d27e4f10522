// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tetwright/label_volume.h"

namespace tetwright {

/// An image in memory: gray values, distances or probabilities on a grid, in one or several channels.
struct ImageVolume : LabelGrid {
  /// Each has a value for each voxel, the first axis fastest. A file's slope and intercept are applied.
  std::vector<std::vector<float>> channels;
};

}  // namespace tetwright

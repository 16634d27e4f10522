// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/types.h"

namespace tetwright {

/// Request to halve the cells around a point.
struct RefinementRegion {
  Vec3 place;
  int halvings;
};

}  // namespace tetwright

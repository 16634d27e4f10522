// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/types.h"

namespace tetwright {

/// A place around which cells are to be halved so many times.
struct RefinementRegion {
  Vec3 place;
  int halvings;
};

}  // namespace tetwright

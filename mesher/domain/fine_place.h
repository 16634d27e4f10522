#pragma once

#include "common/types.h"

namespace tetwright {

/// A place around which cells are to be halved so many times.
struct FinePlace {
  Vec3 place;
  int halvings;
};

}  // namespace tetwright

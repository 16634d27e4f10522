// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "simplify/tuning/tuning.h"

namespace tetwright {

/// Max size of edge and face removals.
struct FlipReach {
  std::size_t max_ring;   ///< tets of a ring within one material
  std::size_t max_faces;  ///< faces removed at once
  /// Whether only the swaps of the paper, section 4, are allowed: rings of three and single faces, and 4-4,
  /// which is its 2-2 at an interface.
  bool basic() const { return max_ring == 3; }
};

inline constexpr FlipReach basic_reach{3, 1};
inline constexpr FlipReach full_reach{SimplifyTuning::Flips::max_ring, SimplifyTuning::Flips::max_faces};

}  // namespace tetwright

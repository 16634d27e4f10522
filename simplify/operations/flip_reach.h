// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tetwright {

/// Max size of edge and face removals.
struct FlipReach {
  std::size_t max_ring = 7;   ///< tets of a ring within one material
  std::size_t max_faces = 5;  ///< max faces removed at once
  /// Whether only the swaps of the paper, section 4, are allowed (and 4-4, its 2-2 on an interface): rings of
  /// three and single faces.
  bool basic() const { return max_ring == 3; }
};

inline constexpr FlipReach basic_reach{3, 1};
inline constexpr FlipReach full_reach{7, 5};

}  // namespace tetwright

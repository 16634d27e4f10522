// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/random.h"
#include "mesher/lattice/octree.h"

namespace tetwright {

/// A box of a few root cells of level 4, refined around some random finest cells.
inline Octree make_random_octree(std::uint64_t seed) {
  Random random(seed);
  std::array<int, 3> cells;
  for (int& n : cells) n = 16 * static_cast<int>(1 + random.below(3));
  std::vector<MortonKey> wanted;
  for (std::uint32_t i = 0, n = 1 + random.below(6); i < n; ++i)
    wanted.push_back(morton_encode(static_cast<int>(random.below(static_cast<std::uint32_t>(cells[0]))),
                                   static_cast<int>(random.below(static_cast<std::uint32_t>(cells[1]))),
                                   static_cast<int>(random.below(static_cast<std::uint32_t>(cells[2])))));
  return build_octree(cells, 4, [&](int level, const std::vector<MortonKey>&) {
    std::vector<MortonKey> split;
    // Stop at coarser cells for some.
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (level > static_cast<int>(i % 3)) split.push_back(wanted[i] >> 3 * level);
    return split;
  });
}

}  // namespace tetwright

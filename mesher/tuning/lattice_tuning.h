// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tetwright {

/// Items that a parallel loop hands out at a time: enough to outweigh the handing out, few enough to keep
/// all threads busy to the end.
struct LatticeGrains {
  static constexpr std::size_t cells = 2048;           ///< of the octree, about a microsecond each
  static constexpr std::size_t sized_cells = 1024;     ///< each looks up max cell sizes
  static constexpr std::size_t tested_cells = 512;     ///< each evaluates a field at some 15 points
  static constexpr std::size_t leaves = 1024;          ///< filled with tets, some microseconds each
  static constexpr std::size_t tets = 1 << 14;         ///< tets or points, some nanoseconds each
  static constexpr std::size_t sampled_points = 1024;  ///< whose distances are looked up
};

/// Octree and lattice; mesher/README.md, Tuned numbers, explains the terms.
struct LatticeTuning {
  struct StarMap {
    /// Number of passes over the tets, each for a part of the points, so that only some rows exist
    /// uncompressed at a time. Trades time for memory.
    static constexpr std::size_t passes = 4;
  };
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// When points were last tried and moved in sweeps over lists of points, by a clock that counts the points of
/// all sweeps in their order. Points are given by their slots. Calls for different points may run
/// concurrently if no call reads a point that another one records.
class LastTries {
 public:
  explicit LastTries(std::size_t slots) : tried_(slots, 0), moved_(slots, 0) {}

  /// \param k position of the point in the list of the current sweep
  void record(Index slot, std::size_t k, bool moved) {
    tried_[slot] = sweep_start_ + k + 1;
    if (moved) moved_[slot] = tried_[slot];
  }
  /// \param points number of points in the list of the sweep
  void end_sweep(std::size_t points) { sweep_start_ += points; }

  bool tried(Index slot) const { return tried_[slot] != 0; }
  /// Whether a point has moved since the last try at another one, or at that try if both are the same.
  bool moved_since(Index slot, Index tried_slot) const {
    return slot == tried_slot ? moved_[slot] == tried_[slot] : moved_[slot] > tried_[tried_slot];
  }

 private:
  std::vector<std::uint64_t> tried_, moved_;  ///< by slot; 0: never
  std::uint64_t sweep_start_ = 0;
};

}  // namespace tetwright

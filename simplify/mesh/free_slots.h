// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The free slots of an array: slots given back, last in first out, then unused ones at its end. A slot given
/// back becomes free only after end_batch(), since otherwise two operations of one batch could write it. One
/// thread at a time.
class FreeSlots {
 public:
  /// Resets the free slots to [first, end).
  void reset(std::size_t first, std::size_t end) {
    free_.clear();
    given_back_.clear();
    first_ = first;
    end_ = end;
  }
  /// Adds free slots at the end.
  void grow(std::size_t count) { end_ += count; }
  std::size_t available() const { return free_.size() + unused(); }
  /// Slots at the end that have never been used.
  std::size_t unused() const { return end_ - first_; }
  /// \pre available() > 0.
  Index take() {
    if (free_.empty()) return static_cast<Index>(first_++);
    const Index slot = free_.back();
    free_.pop_back();
    return slot;
  }
  void give_back(Index slot) { given_back_.push_back(slot); }
  /// Frees the slots given back, which are no longer written.
  void end_batch() {
    free_.insert(free_.end(), given_back_.begin(), given_back_.end());
    given_back_.clear();
  }

 private:
  std::vector<Index> free_, given_back_;
  std::size_t first_ = 0, end_ = 0;
};

}  // namespace tetwright

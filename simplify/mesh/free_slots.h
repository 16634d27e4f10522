// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// The free slots of an array: the ones given back, the last first, then unused ones at its end. A slot given
/// back becomes free only after end_batch(): before that, two operations of one batch could write it. One
/// thread at a time.
class FreeSlots {
 public:
  /// Makes the slots [first, end) the free ones.
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
  /// Frees the slots given back: nobody writes them any more.
  void end_batch() {
    free_.insert(free_.end(), given_back_.begin(), given_back_.end());
    given_back_.clear();
  }

 private:
  std::vector<Index> free_, given_back_;
  std::size_t first_ = 0, end_ = 0;
};

}  // namespace tetwright

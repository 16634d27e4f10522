// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// The free slots of an array: those that operations gave back, the last first, then those at its end that
/// nobody had yet. What is given back in a batch is free only when the batch has been committed: until then
/// two operations would write it. One thread at a time.
class FreeSlots {
 public:
  /// The slots [first, end) are free.
  void reset(std::size_t first, std::size_t end) {
    free_.clear();
    given_back_.clear();
    first_ = first;
    end_ = end;
  }
  /// As many more behind the end.
  void grow(std::size_t count) { end_ += count; }
  std::size_t available() const { return free_.size() + unused(); }
  /// Slots at the end that nobody had yet.
  std::size_t unused() const { return end_ - first_; }
  /// One of the available ones.
  Index take() {
    if (free_.empty()) return static_cast<Index>(first_++);
    const Index slot = free_.back();
    free_.pop_back();
    return slot;
  }
  void give_back(Index slot) { given_back_.push_back(slot); }
  /// Nobody writes what was given back any more.
  void end_batch() {
    free_.insert(free_.end(), given_back_.begin(), given_back_.end());
    given_back_.clear();
  }

 private:
  std::vector<Index> free_, given_back_;
  std::size_t first_ = 0, end_ = 0;
};

}  // namespace tetwright

#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// Free slots at the end of an array, which workers take in lots.
class FreeSlotReserve {
 public:
  /// The slots [first, end) are free. Only while no task runs.
  void reset(std::size_t first, std::size_t end);
  /// Appends the next lot to `free`, in descending order, so that slots are taken from its end in ascending
  /// order; false if none is left. May be called concurrently.
  bool take_lot(std::vector<Index>& free);

 private:
  std::atomic<std::size_t> next_{0};  ///< the first slot that nobody took
  std::size_t end_ = 0;
};

/// A worker's own stock of free slots, refilled from the reserve, so that workers share no list.
class FreeSlots {
 public:
  explicit FreeSlots(FreeSlotReserve& reserve) : reserve_(&reserve) {}
  /// False if fewer than `count` slots can be had.
  bool reserve(std::size_t count) {
    while (free_.size() < count)
      if (!reserve_->take_lot(free_)) return false;
    return true;
  }
  /// A slot that was reserved. Another worker may briefly lock a point slot that its list still names; it
  /// then finds the point dead.
  Index take() {
    const Index slot = free_.back();
    free_.pop_back();
    return slot;
  }
  void give_back(Index slot) { free_.push_back(slot); }

 private:
  FreeSlotReserve* reserve_;
  std::vector<Index> free_;
};

}  // namespace tetwright

#pragma once

#include <cstdint>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// Small hash table from mesh indices to local numbers, emptied in constant time. For one task.
class LocalNumbers {
 public:
  LocalNumbers() { slots_.resize(initial_slots); }
  void clear() {
    size_ = 0;
    if (++epoch_ == 0) restart();
  }
  /// The number of `key`; a key not seen since clear() gets the next one and `added` true.
  std::uint32_t number(Index key, bool& added) {
    std::size_t i = home(key);
    for (; slots_[i].epoch == epoch_; i = (i + 1) & (slots_.size() - 1))
      if (slots_[i].key == key) {
        added = false;
        return slots_[i].number;
      }
    added = true;
    if (2 * (size_ + 1) > slots_.size()) i = grow(key);  // at most half full
    slots_[i] = {key, size_, epoch_};
    return size_++;
  }
  /// The number of `key`, or no_index.
  std::uint32_t find(Index key) const {
    for (std::size_t i = home(key);; i = (i + 1) & (slots_.size() - 1)) {
      if (slots_[i].epoch != epoch_) return no_index;
      if (slots_[i].key == key) return slots_[i].number;
    }
  }
  std::uint32_t size() const { return size_; }

 private:
  static constexpr std::size_t initial_slots = 256;  // a power of two; stars hold 15 points and 24 tets
  struct Slot {
    Index key = 0;
    std::uint32_t number = 0;
    std::uint32_t epoch = 0;
  };
  std::size_t home(Index key) const { return (key * 0x9e3779b1u >> 7) & (slots_.size() - 1); }
  /// Doubles the table; the free slot for `key`.
  std::size_t grow(Index key);
  /// After 2^32 epochs: nothing of before may look current.
  void restart();

  std::vector<Slot> slots_;
  std::uint32_t epoch_ = 1;
  std::uint32_t size_ = 0;
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Small hash table from mesh indices to local numbers, cleared in constant time. For one task at a time.
class LocalNumbers {
 public:
  LocalNumbers() { slots_.resize(initial_slots); }
  void clear() {
    first_ += size_;
    size_ = 0;
    if (first_ > max_first) restart();
  }
  /// The number of `key`; a key not seen since clear() gets the next one and sets `added`.
  std::uint32_t number(Index key, bool& added) {
    std::size_t i = home(key);
    for (; slots_[i].stamp >= first_; i = (i + 1) & mask_)
      if (slots_[i].key == key) {
        added = false;
        return slots_[i].stamp - first_;
      }
    added = true;
    if (2 * size_ > mask_) i = grow(key);  // at most half full
    slots_[i] = {key, first_ + size_};
    return size_++;
  }
  /// The number of `key`, or no_index.
  std::uint32_t find(Index key) const {
    for (std::size_t i = home(key);; i = (i + 1) & mask_) {
      if (slots_[i].stamp < first_) return no_index;
      if (slots_[i].key == key) return slots_[i].stamp - first_;
    }
  }
  std::uint32_t size() const { return size_; }

 private:
  static constexpr std::size_t initial_slots = 256;  // a power of two; stars hold 15 points and 24 tets
  /// Stamps stay below 2^32 if fewer than 2^31 keys are added between two calls of clear().
  static constexpr std::uint32_t max_first = 1u << 31;
  struct Slot {
    Index key = 0;
    std::uint32_t stamp = 0;  ///< first_ + number; free if below first_
  };
  /// Multiplicative hashing by the golden ratio (Knuth 1973, section 6.4); the upper half of the product.
  std::size_t home(Index key) const { return (key * std::uint64_t{0x9e3779b97f4a7c15} >> 32) & mask_; }
  /// Doubles the table and returns the free slot for `key`.
  std::size_t grow(Index key);
  /// Clears all stamps after 2^31 keys, so that no old stamp looks current.
  void restart();

  std::vector<Slot> slots_;
  std::size_t mask_ = initial_slots - 1;
  std::uint32_t first_ = 1;  ///< the stamp of number 0
  std::uint32_t size_ = 0;
};

}  // namespace tetwright

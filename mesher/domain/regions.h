// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "common/types.h"

namespace tetwright {

/// Index of a region of space: 0 is the outside, the materials follow.
using RegionIndex = std::uint16_t;
inline constexpr RegionIndex outside_region = 0;
/// Tag and name of the outside as a material of a mesh that keeps it.
inline constexpr MaterialTag outside_tag = 0;
inline constexpr const char* outside_name = "outside";
/// Marks a point on an interface, in place of its region.
inline constexpr RegionIndex on_interface = 0xffff;

/// How many times cells are halved where walls and gaps of a surface are thin: by default, and at most.
inline constexpr int default_wall_refinement = 3, max_wall_refinement = 8;

/// The regions that meet at a point, ascending: two on an interface, three on a junction curve, four at a
/// corner. More than four do not meet in general position; a lattice point where they appear to is not moved.
class RegionSet {
 public:
  static constexpr int capacity = 4;

  int size() const { return size_; }
  RegionIndex operator[](int i) const { return items_[i]; }
  const RegionIndex* begin() const { return items_.data(); }
  const RegionIndex* end() const { return items_.data() + size_; }
  bool contains(RegionIndex r) const { return std::find(begin(), end(), r) != end(); }
  /// Returns false, without inserting, if the set is full.
  bool insert(RegionIndex r) {
    int i = 0;
    while (i < size_ && items_[i] < r) ++i;
    if (i < size_ && items_[i] == r) return true;
    if (size_ == capacity) return false;
    for (int k = size_; k > i; --k) items_[k] = items_[k - 1];
    items_[i] = r;
    ++size_;
    return true;
  }
  bool operator==(const RegionSet& o) const { return std::equal(begin(), end(), o.begin(), o.end()); }

 private:
  std::array<RegionIndex, capacity> items_{};
  int size_ = 0;
};

}  // namespace tetwright

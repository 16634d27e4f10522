// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Finds points by coordinates, where -0 equals 0 and NaN equals nothing. A hash table of indices that
/// compares the points themselves; 8 to 16 bytes for each distinct point. find() may be called concurrently,
/// add() must not.
/// \pre added points do not change during its lifetime
class PointTable {
 public:
  explicit PointTable(std::span<const Vec3> points, std::size_t expected = 0)
      : points_(points), slots_(std::bit_ceil(std::max<std::size_t>(smallest, 2 * expected)), no_index) {}

  /// \return the first index added with the coordinates of point `i`: `i` itself if they are new
  Index add(Index i) {
    const Vec3& p = points_[i];
    if (p.hasNaN()) return i;  // NaN would be inserted repeatedly and never found
    const std::size_t slot = slot_of(p);
    if (slots_[slot] != no_index) return slots_[slot];
    slots_[slot] = i;
    if (2 * ++size_ > slots_.size()) grow();
    return i;
  }

  /// Index added for these coordinates, or no_index.
  Index find(const Vec3& p) const { return slots_[slot_of(p)]; }

 private:
  static constexpr std::size_t smallest = 1 << 10;  // 4 KB

  /// Applies the finalizer of splitmix64 (Steele et al. 2014) after each coordinate: neighbours on a grid
  /// differ in few high bits but must hash far apart.
  static std::uint64_t hash(const Vec3& p) {
    std::uint64_t h = 0;
    for (int axis = 0; axis < 3; ++axis) {
      h += std::bit_cast<std::uint64_t>(p[axis] + 0.0) + 0x9e3779b97f4a7c15;  // + 0.0 makes -0 a 0
      h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9;
      h = (h ^ h >> 27) * 0x94d049bb133111eb;
      h ^= h >> 31;
    }
    return h;
  }

  /// Slot of these coordinates, or an empty slot if they are absent. An empty slot exists, since at most half
  /// of the slots are full.
  std::size_t slot_of(const Vec3& p) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash(p) & mask;
    while (slots_[slot] != no_index && points_[slots_[slot]] != p) slot = (slot + 1) & mask;
    return slot;
  }

  void grow() {
    std::vector<Index> old(2 * slots_.size(), no_index);
    std::swap(old, slots_);
    for (const Index i : old)
      if (i != no_index) slots_[slot_of(points_[i])] = i;
  }

  std::span<const Vec3> points_;
  std::vector<Index> slots_;
  std::size_t size_ = 0;
};

}  // namespace tetwright

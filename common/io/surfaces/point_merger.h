// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "common/io/surfaces/surface_builder.h"

namespace tetwright {

/// Merges points with equal coordinates, for formats in which triangles do not share vertices. A hash table
/// with open addressing, at most half full.
class PointMerger {
 public:
  PointMerger(SurfaceBuilder& surface, std::size_t expected)
      : surface_(surface), table_(std::bit_ceil(expected * 2 + 16), no_index) {
    points_.reserve(expected);
  }

  template <class Place>
  std::int64_t add(Vec3 p, const Place& place) {
    for (int k = 0; k < 3; ++k)
      if (p[k] == 0) p[k] = 0;  // equate -0 and 0
    if (points_.size() * 2 >= table_.size()) grow();
    std::size_t slot = hash(p) & (table_.size() - 1);
    for (; table_[slot] != no_index; slot = (slot + 1) & (table_.size() - 1))
      if (points_[table_[slot]] == p) return table_[slot];
    surface_.add_point(p, place);
    table_[slot] = static_cast<Index>(points_.size());
    points_.push_back(p);
    return table_[slot];
  }

 private:
  static std::size_t hash(const Vec3& p) {
    std::uint64_t h = 0;
    for (int k = 0; k < 3; ++k) {
      h = (h ^ std::bit_cast<std::uint64_t>(p[k])) * 0x9e3779b97f4a7c15u;
      h ^= h >> 32;
    }
    return static_cast<std::size_t>(h);
  }
  void grow() {
    table_.assign(table_.size() * 2, no_index);
    for (Index i = 0; i < points_.size(); ++i) {
      std::size_t slot = hash(points_[i]) & (table_.size() - 1);
      while (table_[slot] != no_index) slot = (slot + 1) & (table_.size() - 1);
      table_[slot] = i;
    }
  }

  SurfaceBuilder& surface_;
  std::vector<Vec3> points_;
  std::vector<Index> table_;
};

}  // namespace tetwright

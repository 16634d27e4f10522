// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// Morton keys: the bits of three coordinates in [0, 2^21) interleaved, x in the lowest bit. Cells of a cube
/// of 2^k cells, sorted by key, are in the order of a depth-first traversal of its octree.
using MortonKey = std::uint64_t;

/// Half the diagonal of a cell over its edge: sqrt(3) / 2.
inline constexpr double half_cube_diagonal = 0.8660254037844386;

namespace detail {

/// Inserts two zero bits between any two of the lowest 21 bits of v.
constexpr std::uint64_t spread_bits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x001f00000000ffff;
  v = (v | v << 16) & 0x001f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  v = (v | v << 2) & 0x1249249249249249;
  return v;
}

constexpr std::uint64_t gather_bits(std::uint64_t v) {
  v &= 0x1249249249249249;
  v = (v | v >> 2) & 0x10c30c30c30c30c3;
  v = (v | v >> 4) & 0x100f00f00f00f00f;
  v = (v | v >> 8) & 0x001f0000ff0000ff;
  v = (v | v >> 16) & 0x001f00000000ffff;
  v = (v | v >> 32) & 0x1fffff;
  return v;
}

}  // namespace detail

constexpr MortonKey morton_encode(int x, int y, int z) {
  return detail::spread_bits(static_cast<std::uint64_t>(x)) |
         detail::spread_bits(static_cast<std::uint64_t>(y)) << 1 |
         detail::spread_bits(static_cast<std::uint64_t>(z)) << 2;
}

constexpr MortonKey morton_encode(const std::array<int, 3>& p) { return morton_encode(p[0], p[1], p[2]); }

constexpr std::array<int, 3> morton_decode(MortonKey key) {
  return {static_cast<int>(detail::gather_bits(key)), static_cast<int>(detail::gather_bits(key >> 1)),
          static_cast<int>(detail::gather_bits(key >> 2))};
}

/// Morton keys of points in a box, with 2^21 cells along its longest side.
class MortonGrid {
 public:
  MortonGrid(const Vec3& low, const Vec3& high) : low_(low) {
    const double extent = std::max((high - low).maxCoeff(), std::numeric_limits<double>::min());
    to_cell_ = (0x1p21 - 1) / extent;
  }
  /// Points outside the box get the key of a cell on its boundary, as do all points of a box whose extent
  /// overflows.
  MortonKey key(const Vec3& p) const {
    const auto cell = [&](int axis) {
      const double c = (p[axis] - low_[axis]) * to_cell_;
      return c > 0 ? static_cast<int>(std::min(c, 0x1p21 - 1)) : 0;  // also if c is NaN
    };
    return morton_encode(cell(0), cell(1), cell(2));
  }

 private:
  Vec3 low_;
  double to_cell_;
};

/// std::lower_bound in an ascending list by exponential search from `hint`, a position likely to be near the
/// result: time is logarithmic in the distance between them (Bentley & Yao 1976).
inline std::size_t lower_bound_near(const std::vector<std::uint64_t>& ascending, std::uint64_t value,
                                    std::size_t hint) {
  std::size_t low = 0, high = ascending.size();
  if (hint < high && ascending[hint] < value) {
    low = hint + 1;
    for (std::size_t step = 1; low + step < high; step *= 2) {
      if (ascending[low + step] >= value) {
        high = low + step;
        break;
      }
      low += step + 1;
    }
  } else if (hint < high) {
    high = hint;
    for (std::size_t step = 1; step <= high; step *= 2) {
      if (ascending[high - step] < value) {
        low = high - step + 1;
        break;
      }
      high -= step;
    }
  }
  return static_cast<std::size_t>(std::lower_bound(ascending.begin() + static_cast<std::ptrdiff_t>(low),
                                                   ascending.begin() + static_cast<std::ptrdiff_t>(high),
                                                   value) -
                                  ascending.begin());
}

}  // namespace tetwright

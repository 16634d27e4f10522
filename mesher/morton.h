#pragma once

#include <array>
#include <cstdint>

namespace tetwright {

/// Morton keys: the bits of three coordinates interleaved, x in the lowest place. Cells of a cube of 2^k
/// cells that are sorted by key are in the order of a depth-first walk of its octree. Coordinates in [0,
/// 2^21).
using MortonKey = std::uint64_t;

namespace detail {

/// Two zero bits between any two of the lowest 21 bits of v.
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

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>

namespace tetwright {

/// The output function of SplitMix64 (see Random): scatters the bits of a number, one-to-one.
constexpr std::uint64_t mixed_bits(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// SplitMix64 (Steele, Lea & Flood 2014): the same numbers from the same seed on every machine and compiler,
/// which the standard library's distributions and shuffles do not guarantee.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  /// An independent stream for each combination of the three arguments.
  Random(std::uint64_t seed, std::uint64_t stream, std::uint64_t substream)
      : state_(mixed_bits(mixed_bits(mixed_bits(seed) ^ stream) ^ substream)) {}

  std::uint64_t next() { return mixed_bits(state_ += 0x9e3779b97f4a7c15u); }
  /// Uniform in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  /// Uniform in [0, n), n > 0 (multiply-shift, Lemire 2019; its bias of n / 2^32 does not matter here).
  std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>((static_cast<std::uint64_t>(n) * (next() >> 32)) >> 32);
  }
  /// Fisher-Yates shuffle.
  template <class T>
  void shuffle(std::span<T> items) {
    for (std::size_t i = items.size(); i > 1; --i)
      std::swap(items[i - 1], items[below(static_cast<std::uint32_t>(i))]);
  }

 private:
  std::uint64_t state_;
};

}  // namespace tetwright

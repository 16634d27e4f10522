// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

namespace tetwright {

/// Loads a number from bytes that need not be aligned.
/// \param swap true if the bytes are not in this machine's order
template <class Number>
Number load(const char* from, bool swap) {
  std::array<char, sizeof(Number)> bytes;
  std::memcpy(bytes.data(), from, sizeof(Number));
  if (swap) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<Number>(bytes);
}

inline constexpr bool little_endian_machine = std::endian::native == std::endian::little;

/// Appends the bytes of the number in little-endian order.
template <class Number>
void append_bytes(std::string& out, Number number) {
  auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  if (!little_endian_machine) std::reverse(bytes.begin(), bytes.end());
  out.append(bytes.data(), bytes.size());
}

}  // namespace tetwright

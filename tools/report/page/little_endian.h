// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace tetwright {

/// Appends the lowest `bytes` bytes of a number, the lowest one first.
inline void append_little_endian(std::string& out, std::uint32_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xff);
}

/// How many bytes the numbers below `count` need, 1 to 4.
inline std::size_t bytes_for(std::size_t count) {
  std::size_t bytes = 1;
  while (bytes < 4 && count > std::size_t{1} << (8 * bytes)) ++bytes;
  return bytes;
}

}  // namespace tetwright

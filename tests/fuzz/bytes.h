// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace tetwright::fuzz {

/// Returns the bytes of the input one by one, then zeros.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}
  bool empty() const { return bytes_.empty(); }
  std::uint32_t below(std::uint32_t n) {
    if (empty()) return 0;
    const auto first = static_cast<unsigned char>(bytes_.front());
    bytes_.remove_prefix(1);
    return first % n;
  }

 private:
  std::string_view bytes_;
};

}  // namespace tetwright::fuzz

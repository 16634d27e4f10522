// SPDX-License-Identifier: Apache-2.0
#include "common/utf8.h"

namespace tetwright {

Utf8Part first_utf8_part(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return {1, true};
  const std::size_t n = first >= 0xf0 && first <= 0xf4  ? 4
                        : first >= 0xe0 && first < 0xf0 ? 3
                        : first >= 0xc2 && first < 0xe0 ? 2
                                                        : 1;
  if (n == 1) return {1, false};
  for (std::size_t i = 1; i < n; ++i) {
    // The second byte reveals overlong forms, surrogates and values beyond the last code point.
    const unsigned char low = i > 1 ? 0x80 : first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
    const unsigned char high = i > 1 ? 0xbf : first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
    if (i == text.size() || byte(i) < low || byte(i) > high) return {i, false};
  }
  return {n, true};
}

std::string valid_utf8(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const Utf8Part part = first_utf8_part(text);
    if (part.valid)
      out += text.substr(0, part.size);
    else
      out += "\xef\xbf\xbd";
    text.remove_prefix(part.size);
  }
  return out;
}

std::string printable_name(const std::string& name) {
  std::string out;
  for (const char c : valid_utf8(name)) out += static_cast<unsigned char>(c) < ' ' ? '_' : c;
  return out;
}

}  // namespace tetwright

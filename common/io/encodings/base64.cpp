// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/base64.h"

#include <array>
#include <cstdint>

namespace tetwright {

namespace {

constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Values of base64 characters, 0 to 63; -1 for others.
constexpr std::array<std::int8_t, 256> make_values() {
  std::array<std::int8_t, 256> values{};
  for (std::int8_t& v : values) v = -1;
  for (std::size_t i = 0; i < alphabet.size(); ++i)
    values[static_cast<unsigned char>(alphabet[i])] = static_cast<std::int8_t>(i);
  return values;
}
constexpr std::array<std::int8_t, 256> base64_values = make_values();

}  // namespace

void append_base64(std::string& out, std::string_view bytes) {
  const auto at = [&](std::size_t i) -> std::uint32_t { return static_cast<unsigned char>(bytes[i]); };
  out.reserve(out.size() + (bytes.size() + 2) / 3 * 4);
  std::size_t i = 0;
  for (; i + 2 < bytes.size(); i += 3) {
    const std::uint32_t v = at(i) << 16 | at(i + 1) << 8 | at(i + 2);
    const char quad[4] = {alphabet[v >> 18], alphabet[v >> 12 & 63], alphabet[v >> 6 & 63], alphabet[v & 63]};
    out.append(quad, 4);
  }
  if (i == bytes.size()) return;
  const bool two = i + 1 < bytes.size();
  const std::uint32_t v = at(i) << 16 | (two ? at(i + 1) << 8 : 0);
  out += alphabet[v >> 18];
  out += alphabet[v >> 12 & 63];
  out += two ? alphabet[v >> 6 & 63] : '=';
  out += '=';
}

bool Base64Reader::decode_quad() {
  std::uint32_t v = 0;
  int digits = 0, padding = 0;
  while (digits + padding < 4 && position_ < text_.size()) {
    const char c = text_[position_];
    const std::int8_t digit = base64_values[static_cast<unsigned char>(c)];
    if (digit >= 0 && padding == 0) {
      v = v << 6 | static_cast<std::uint32_t>(digit);
      ++digits;
    } else if (c == '=' && digits >= 2) {
      v <<= 6;
      ++padding;
    } else if (c != ' ' && c != '\n' && c != '\r' && c != '\t') {
      return false;
    }
    ++position_;
  }
  if (digits + padding < 4) return false;
  for (int k = 0; k < 3; ++k) buffer_[k] = static_cast<char>(v >> (16 - 8 * k) & 255);
  size_ = ready_ = 3 - static_cast<std::size_t>(padding);
  return true;
}

std::size_t Base64Reader::read(char* to, std::size_t n) {
  for (std::size_t done = 0; done < n; ++done) {
    if (ready_ == 0 && !decode_quad()) return done;
    to[done] = buffer_[size_ - ready_--];
  }
  return n;
}

}  // namespace tetwright

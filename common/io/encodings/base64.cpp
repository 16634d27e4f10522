// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/base64.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "tetwright/resources.h"

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

/// Bytes encoded by each task of a parallel loop, a multiple of 3: some ten microseconds.
constexpr std::size_t encode_grain = 3 * 4096;

/// Encodes three bytes each as four characters; `bytes.size()` is a multiple of 3.
void encode_groups(std::string_view bytes, char* to) {
  const auto at = [&](std::size_t i) -> std::uint32_t { return static_cast<unsigned char>(bytes[i]); };
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::uint32_t v = at(i) << 16 | at(i + 1) << 8 | at(i + 2);
    *to++ = alphabet[v >> 18];
    *to++ = alphabet[v >> 12 & 63];
    *to++ = alphabet[v >> 6 & 63];
    *to++ = alphabet[v & 63];
  }
}

/// Encodes the last one or two bytes.
void append_end(std::string& out, std::string_view bytes) {
  if (bytes.empty()) return;
  const auto at = [&](std::size_t i) -> std::uint32_t { return static_cast<unsigned char>(bytes[i]); };
  const bool two = bytes.size() == 2;
  const std::uint32_t v = at(0) << 16 | (two ? at(1) << 8 : 0);
  out += alphabet[v >> 18];
  out += alphabet[v >> 12 & 63];
  out += two ? alphabet[v >> 6 & 63] : '=';
  out += '=';
}

}  // namespace

void append_base64(std::string& out, std::string_view bytes) {
  const std::size_t before = out.size(), groups = bytes.size() / 3;
  out.resize(before + 4 * groups);
  encode_groups(bytes.substr(0, 3 * groups), out.data() + before);
  append_end(out, bytes.substr(3 * groups));
}

std::string base64(std::string_view bytes) {
  const std::size_t whole = bytes.size() / 3 * 3;
  std::string out(whole / 3 * 4, '\0');
  parallel_for(0, whole, encode_grain, [&](std::size_t begin, std::size_t end) {
    encode_groups(bytes.substr(begin, end - begin), out.data() + begin / 3 * 4);
  });
  append_end(out, bytes.substr(whole));
  return out;
}

bool decode_base64(std::string_view text, std::size_t begin, std::span<char> to) {
  if (to.empty()) return true;
  const std::size_t end = begin + to.size(), first = begin / 3, last = (end - 1) / 3;  // groups
  if (last >= text.size() / 4) return false;
  const auto value = [&](std::size_t i) {
    return std::int32_t{base64_values[static_cast<unsigned char>(text[i])]};
  };
  const auto byte = [](std::int32_t v, std::size_t k) { return static_cast<char>(v >> (16 - 8 * k) & 255); };
  // Negative if a character is not base64.
  const auto group = [&](std::size_t g) {
    return value(4 * g) << 18 | value(4 * g + 1) << 12 | value(4 * g + 2) << 6 | value(4 * g + 3);
  };
  const auto decode_part = [&](std::size_t g) {
    // Padding may follow the bytes of the last group.
    const std::size_t part_end = std::min<std::size_t>(3, end - 3 * g);
    std::int32_t v = 0;
    bool padded = false;
    for (std::size_t k = 0; k < 4; ++k) {
      padded |= k > part_end && text[4 * g + k] == '=';
      if (padded && text[4 * g + k] != '=') return false;
      v = v << 6 | (padded ? 0 : value(4 * g + k));
    }
    for (std::size_t k = begin > 3 * g ? begin - 3 * g : 0; k < part_end; ++k)
      to[3 * g + k - begin] = byte(v, k);
    return v >= 0;
  };
  bool valid = decode_part(first) && decode_part(last);
  for (std::size_t g = first + 1; g < last; ++g) {
    const std::int32_t v = group(g);
    valid &= v >= 0;
    char* const at = to.data() + (3 * g - begin);
    for (std::size_t k = 0; k < 3; ++k) at[k] = byte(v, k);
  }
  return valid;
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

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "common/types.h"

namespace tetwright {

/// A number with at most six significant digits ("%.6g"), for messages that people read. Files get the
/// shortest text that is read back as the same bits, see number_text.h.
inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// "(x, y, z)" for messages.
inline std::string place_text(const Vec3& place) {
  return "(" + short_number(place.x()) + ", " + short_number(place.y()) + ", " + short_number(place.z()) +
         ")";
}

/// The text with question marks for control characters.
inline std::string printable(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == 127) c = '?';
  return text;
}

/// A value from a file or the command line as messages show it: quoted, cut after 40 characters, with '?' for
/// everything but printable ASCII.
inline std::string in_quotes(std::string_view value) {
  constexpr std::size_t longest = 40;
  std::string out = "\"";
  for (char c : value.substr(0, longest)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (value.size() > longest ? "...\"" : "\"");
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Formats a number for messages with at most six significant digits ("%.6g"). Files use append_number() of
/// number_text.h, which round-trips.
inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// Formats a position for messages: "(x, y, z)".
inline std::string place_text(const Vec3& place) {
  return "(" + short_number(place.x()) + ", " + short_number(place.y()) + ", " + short_number(place.z()) +
         ")";
}

/// Replaces control characters by question marks.
inline std::string printable(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == 127) c = '?';
  return text;
}

/// Formats a value from a file or the command line for messages: quoted, truncated to 40 characters, with '?'
/// for everything but printable ASCII.
inline std::string in_quotes(std::string_view value) {
  constexpr std::size_t longest = 40;
  std::string out = "\"";
  for (char c : value.substr(0, longest)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (value.size() > longest ? "...\"" : "\"");
}

}  // namespace tetwright

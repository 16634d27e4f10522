// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <string>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Appends a number as text. A double is written as the shortest text that reads back to the same bits.
template <class Number>
void append_number(std::string& out, Number value) {
  char buffer[32];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof(buffer), value).ptr);
}

/// Appends "x y z".
inline void append_point(std::string& out, const Vec3& p) {
  append_number(out, p.x());
  out += ' ';
  append_number(out, p.y());
  out += ' ';
  append_number(out, p.z());
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

#include "common/utf8.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Label of a group for messages: its name on one line, its number if it has no name, or "none".
inline std::string group_text(const SurfaceRegion& group) {
  if (!group) return "none";
  return group.name.empty() ? std::to_string(group.number) : printable_name(group.name);
}

/// printable_name() with underscores for white space.
inline std::string printable_word(const std::string& name) {
  std::string word = printable_name(name);
  std::replace(word.begin(), word.end(), ' ', '_');
  return word;
}

/// printable_word() for formats in which # begins a comment.
inline std::string word_without_hash(const std::string& name) {
  std::string word = printable_word(name);
  std::replace(word.begin(), word.end(), '#', '_');
  return word;
}

}  // namespace tetwright

#pragma once

#include <string>

#include "common/face_group.h"
#include "common/utf8.h"

namespace tetwright {

/// What a file calls a group: its name on one line, or its number where it has none, or "none".
inline std::string group_text(const FaceGroup& group) {
  if (!group) return "none";
  return group.name.empty() ? std::to_string(group.number) : printable_name(group.name);
}

/// The text with underscores for white space.
inline std::string one_word(std::string text) {
  for (char& c : text)
    if (c == ' ') c = '_';
  return text;
}

}  // namespace tetwright

#pragma once

#include <cstdio>
#include <string>

namespace tetwright {

/// A number with at most six significant digits ("%.6g"), for messages that people read. Files get the
/// shortest text that is read back as the same bits, see number_text.h.
inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace tetwright

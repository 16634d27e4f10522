// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace tetwright {

/// Removes ASCII white space at both ends.
inline std::string_view trimmed(std::string_view text) {
  constexpr std::string_view white_space = " \t\r\n\v\f";
  const std::size_t begin = text.find_first_not_of(white_space);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(white_space) - begin + 1);
}

}  // namespace tetwright

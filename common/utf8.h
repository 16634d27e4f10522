// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tetwright {

/// The beginning of a text.
struct Utf8Part {
  std::size_t size;  ///< bytes
  bool valid;        ///< one character; otherwise bytes that begin none, up to the first that tells
};

/// The first part of `text`, which must not be empty. Overlong forms, surrogates and values beyond the last
/// code point are not valid.
Utf8Part first_utf8_part(std::string_view text);

/// The text with a replacement character (U+FFFD) for each part that is not valid: what `--stats` makes of
/// it, too.
std::string valid_utf8(std::string_view text);

/// valid_utf8() with underscores for control characters: a name as it may stand on a line.
std::string printable_name(const std::string& name);

}  // namespace tetwright

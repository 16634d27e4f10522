// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tetwright {

/// First part of a text.
struct Utf8Part {
  std::size_t size;  ///< bytes
  bool valid;        ///< true: one character; false: bytes that begin none, up to the first that proves it
};

/// Returns the first part of `text`. Overlong forms, surrogates and values beyond the last code point are
/// invalid.
/// \pre `text` is not empty
Utf8Part first_utf8_part(std::string_view text);

/// Replaces each invalid part by the replacement character (U+FFFD), as `--stats` does.
std::string valid_utf8(std::string_view text);

/// valid_utf8() with underscores for control characters: a name that fits on one line.
std::string printable_name(const std::string& name);

}  // namespace tetwright

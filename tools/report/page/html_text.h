// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tetwright {

/// Escapes a text for HTML content and double-quoted attributes. Control characters become underscores, bytes
/// that are not UTF-8 replacement characters.
std::string html_text(std::string_view text);

/// Escapes JSON for a script element: nothing in it ends the element or begins a comment.
///
/// \pre `json` is valid, so that the escaped characters occur in strings only.
std::string script_json(std::string_view json);

/// A number with this many decimals, independent of the locale.
std::string fixed_number(double value, int decimals);

/// A whole number in groups of three: 1,234,567.
std::string grouped_number(std::size_t value);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tetwright {

/// A text as it may stand between elements and in attributes within double quotes: no byte of it is markup.
/// Control characters become underscores, bytes that are not UTF-8 replacement characters.
std::string html_text(std::string_view text);

/// JSON as it may stand in a script element: nothing in it ends the element or begins a comment. `json` is
/// valid JSON, in which what is escaped stands in strings alone.
std::string script_json(std::string_view json);

/// A number with this many decimals, whatever the locale.
std::string fixed_number(double value, int decimals);

/// A whole number in groups of three: 1,234,567.
std::string grouped_number(std::size_t value);

}  // namespace tetwright

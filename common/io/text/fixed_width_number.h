// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace tetwright {

/// Formats a finite number in at most `width` characters (at least 9) with a decimal point: the shortest text
/// that reads back to the same bits if it fits, otherwise the nearest value that does.
/// \param bare_exponent true: omit the letter before an exponent ("1.5-7", "1.5+20"), as Nastran allows
std::string fixed_width_number(double value, std::size_t width, bool bare_exponent = false);

}  // namespace tetwright

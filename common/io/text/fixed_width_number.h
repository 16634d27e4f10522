// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace tetwright {

/// The number as text of at most `width` characters (at least 9) with a decimal point: the shortest that is
/// read back as the same bits where that fits, else the nearest that does. Of finite numbers.
///
/// With `bare_exponent` the letter before an exponent is left out ("1.5-7", "1.5+20"), as Nastran allows.
std::string fixed_width_number(double value, std::size_t width, bool bare_exponent = false);

}  // namespace tetwright

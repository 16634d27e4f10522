// SPDX-License-Identifier: Apache-2.0
#include "common/io/text/fixed_width_number.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Shortens a number without changing its value: removes "+" and leading zeros of the exponent; adds a
/// decimal point.
std::string tidied(std::string text, bool bare_exponent) {
  std::string exponent;
  if (const std::size_t e = text.find('e'); e != std::string::npos) {
    exponent = text.substr(e + 1);
    text.resize(e);
    const bool negative = exponent[0] == '-';
    exponent.erase(0, exponent.find_first_not_of("+-0"));
    exponent = std::string(negative ? "-" : bare_exponent ? "+" : "") + exponent;
    if (!bare_exponent) exponent = "e" + exponent;
  }
  if (text.find('.') == std::string::npos) text += '.';
  while (text.ends_with("0") && text.find('.') != std::string::npos) text.pop_back();
  if (text.ends_with(".")) text += '0';
  return text + exponent;
}

}  // namespace

std::string fixed_width_number(double value, std::size_t width, bool bare_exponent) {
  TETWRIGHT_CHECK(std::isfinite(value));
  char buffer[400];  // room for the longest double in fixed notation
  char* end = buffer;
  const auto text_of = [&](auto... how) {
    end = std::to_chars(buffer, buffer + sizeof buffer, value, how...).ptr;
    return tidied(std::string(buffer, end), bare_exponent);
  };
  if (std::string shortest = text_of(); shortest.size() <= width) return shortest;
  std::string best;
  double best_error = std::numeric_limits<double>::infinity();
  for (const std::chars_format format : {std::chars_format::fixed, std::chars_format::scientific})
    for (int digits = std::numeric_limits<double>::max_digits10; digits >= 0; --digits) {
      if (format == std::chars_format::fixed && std::fabs(value) >= 1e16) break;
      const std::string text = text_of(format, digits);
      if (text.size() > width) continue;
      double read = 0;
      // The largest doubles overflow when they are rounded up.
      if (std::from_chars(buffer, end, read).ec == std::errc::result_out_of_range && std::fabs(value) > 1)
        return fixed_width_number(value * (1 - std::pow(10.0, -digits)), width, bare_exponent);
      const double error = std::fabs(read - value);
      if (error < best_error) {
        best_error = error;
        best = text;
      }
      break;
    }
  return best;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/io/text/fixed_width_number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "common/io/text/text_scanner.h"

namespace tetwright::fixed_width_number_test {
namespace {

/// Value of the text, also in Nastran's notation.
double value_of(std::string text) {
  const std::size_t sign = text.find_first_of("+-", 1);
  if (text.find('e') == std::string::npos && sign != std::string::npos) text.insert(sign, "e");
  double value = 0;
  EXPECT_TRUE(parse_number(text, value)) << text;
  return value;
}

TEST(FixedWidthNumber, ShortNumbersAreExact) {
  EXPECT_EQ(fixed_width_number(0, 20), "0.0");
  EXPECT_EQ(fixed_width_number(-1, 20), "-1.0");
  EXPECT_EQ(fixed_width_number(0.1, 16), "0.1");
  EXPECT_EQ(fixed_width_number(-2.5e-7, 20), "-2.5e-7");
  EXPECT_EQ(fixed_width_number(-2.5e-7, 16, true), "-2.5-7");
  EXPECT_EQ(fixed_width_number(1e22, 16, true), "1.0+22");
  EXPECT_EQ(fixed_width_number(1e22, 20), "1.0e22");
}

TEST(FixedWidthNumber, OthersAreRoundedToWhatFits) {
  EXPECT_EQ(fixed_width_number(-1.0 / 3, 16, true), "-0.3333333333333");
  EXPECT_EQ(fixed_width_number(2.0 / 3e9, 16, true), "6.66666666667-10");
  const std::vector<double> hard = {5e-324,
                                    -1.7976931348623157e308,
                                    -2.2250738585072014e-308,
                                    123456789012345678.0,
                                    -0.00012345678901234567,
                                    9.9999999999999995e-5,
                                    -99999999999999.98};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> size(-20, 20);
  for (std::size_t i = 0; i < 20000; ++i) {
    const double value = i < hard.size() ? hard[i] : (i % 2 ? -1 : 1) * std::pow(10.0, size(random));
    for (const bool bare : {false, true}) {
      const std::string narrow = fixed_width_number(value, 16, bare),
                        wide = fixed_width_number(value, 20, bare);
      ASSERT_LE(narrow.size(), 16u) << narrow;
      ASSERT_LE(wide.size(), 20u) << wide;
      ASSERT_NE(wide.find('.'), std::string::npos) << wide;
      // A three-digit exponent leaves less room.
      if (std::fabs(value) < 1e-99 || std::fabs(value) > 1e99) continue;
      // The worst case has a sign, a point, and an exponent of four characters ("e-12").
      ASSERT_LE(std::fabs(value_of(wide) / value - 1), bare ? 5e-14 : 5e-13) << wide;
      ASSERT_LE(std::fabs(value_of(narrow) / value - 1), bare ? 5e-10 : 5e-9) << narrow;
    }
  }
}

}  // namespace
}  // namespace tetwright::fixed_width_number_test

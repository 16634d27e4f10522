// SPDX-License-Identifier: Apache-2.0
#include "common/io/text/text_scanner.h"

#include <cmath>
#include <limits>

#include "tests/common/io/expect_error.h"

namespace tetwright::text_scanner_test {
namespace {

TEST(TextScanner, WordsAndLines) {
  TextScanner in("one two # not this\r\n\rthree\n  four rest of it \nfive", "f", '#');
  EXPECT_EQ(in.word(), "one");
  EXPECT_EQ(in.word_on_line(), "two");
  EXPECT_EQ(in.word_on_line(), "");
  EXPECT_EQ(in.line(), 1u);
  EXPECT_EQ(in.word(), "three");
  EXPECT_EQ(in.line(), 3u);
  EXPECT_EQ(in.word(), "four");
  EXPECT_EQ(in.rest_of_line(), " rest of it ");
  EXPECT_FALSE(in.at_end());
  EXPECT_EQ(in.word(), "five");
  EXPECT_EQ(in.word(), "");
  EXPECT_TRUE(in.at_end());
}

TEST(TextScanner, AByteOrderMarkIsSkipped) {
  TextScanner in("\xef\xbb\xbfply\n", "f");
  EXPECT_EQ(in.word(), "ply");
}

TEST(TextScanner, Numbers) {
  double x = 0;
  EXPECT_TRUE(parse_number("+1.5e1", x));
  EXPECT_EQ(x, 15);
  EXPECT_TRUE(parse_number("1e-400", x));
  EXPECT_EQ(x, 0);
  EXPECT_TRUE(parse_number("-1e400", x));
  EXPECT_EQ(x, -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(parse_number("NaN", x));
  EXPECT_TRUE(std::isnan(x));
  std::int64_t i = 0;
  EXPECT_TRUE(parse_number("+7", i));
  EXPECT_EQ(i, 7);
  for (const char* bad : {"", "+", "+-1", "1x", "0x10", "--1", "1e", "1,5"}) {
    EXPECT_FALSE(parse_number(bad, x)) << bad;
    EXPECT_FALSE(parse_number(bad, i)) << bad;
  }
  EXPECT_FALSE(parse_number("99999999999999999999", i));
}

TEST(TextScanner, QuotesAreTamed) {
  EXPECT_EQ(in_quotes("a\nb\x01\xff"), "\"a?b??\"");
  EXPECT_EQ(in_quotes(std::string(100, 'x')), "\"" + std::string(40, 'x') + "...\"");
}

}  // namespace
}  // namespace tetwright::text_scanner_test

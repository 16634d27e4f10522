// SPDX-License-Identifier: Apache-2.0
#include "common/utf8.h"

#include <gtest/gtest.h>

namespace tetwright::utf8_test {
namespace {

TEST(Utf8, WhatIsNotValidIsReplaced) {
  const std::string r = "\xef\xbf\xbd";
  for (const char* fine : {"", "plain", "\xc3\xa4", "\xe2\x82\xac", "\xf0\x9f\x98\x80", "\xf4\x8f\xbf\xbf"})
    EXPECT_EQ(valid_utf8(fine), fine);
  EXPECT_EQ(valid_utf8("K\xf6rper"), "K" + r + "rper");  // Latin-1
  EXPECT_EQ(valid_utf8("\xe2\x82"
                       "a\xc3"),
            r + "a" + r);                                            // truncated: one for each character
  EXPECT_EQ(valid_utf8("\xc0\xaf"), r + r);                          // overlong
  EXPECT_EQ(valid_utf8("\xed\xa0\x80"), r + r + r);                  // a surrogate
  EXPECT_EQ(valid_utf8("\xf4\x90\x80\x80\xff"), r + r + r + r + r);  // beyond the last code point
}

}  // namespace
}  // namespace tetwright::utf8_test

// SPDX-License-Identifier: Apache-2.0
#include "tools/app/nearest_word.h"

#include <gtest/gtest.h>

#include <vector>

namespace tetwright::nearest_word_test {
namespace {

TEST(NearestWord, CountsTypingErrors) {
  EXPECT_EQ(typing_errors("", ""), 0u);
  EXPECT_EQ(typing_errors("mesh", "mesh"), 0u);
  EXPECT_EQ(typing_errors("", "mesh"), 4u);
  EXPECT_EQ(typing_errors("mesh", ""), 4u);
  EXPECT_EQ(typing_errors("msh", "mesh"), 1u);    // missing letter
  EXPECT_EQ(typing_errors("meesh", "mesh"), 1u);  // additional letter
  EXPECT_EQ(typing_errors("mash", "mesh"), 1u);   // wrong letter
  EXPECT_EQ(typing_errors("mehs", "mesh"), 1u);   // swapped letters
  EXPECT_EQ(typing_errors("kitten", "sitting"), 3u);
  EXPECT_EQ(typing_errors("sitting", "kitten"), 3u);
}

TEST(NearestWord, ChoosesTheFewestErrorsThenTheFirst) {
  const std::vector<std::string> commands{"prepare", "mesh", "simplify", "improve", "check", "sample"};
  EXPECT_EQ(nearest_word("simpilfy", commands), "simplify");
  EXPECT_EQ(nearest_word("chekc", commands), "check");
  EXPECT_EQ(nearest_word("frob", commands), "mesh");
  EXPECT_EQ(nearest_word("x", std::vector<std::string>{"ab", "cd"}), "ab");
  EXPECT_EQ(nearest_word("x", {}), "");
  EXPECT_NE(nearest_word(std::string(1'000'000, 'x'), commands), "");
}

}  // namespace
}  // namespace tetwright::nearest_word_test

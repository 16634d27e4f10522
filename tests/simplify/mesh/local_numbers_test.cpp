// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/local_numbers.h"

#include <gtest/gtest.h>

namespace tetwright::local_numbers_test {
namespace {

TEST(LocalNumbers, NumbersInTheOrderOfFirstSight) {
  LocalNumbers numbers;
  bool added = false;
  EXPECT_EQ(numbers.number(7, added), 0u);
  EXPECT_TRUE(added);
  EXPECT_EQ(numbers.number(3, added), 1u);
  EXPECT_EQ(numbers.number(7, added), 0u);
  EXPECT_FALSE(added);
  EXPECT_EQ(numbers.find(3), 1u);
  EXPECT_EQ(numbers.find(4), no_index);
  numbers.clear();
  EXPECT_EQ(numbers.size(), 0u);
  EXPECT_EQ(numbers.find(7), no_index);
  EXPECT_EQ(numbers.number(3, added), 0u);
  EXPECT_TRUE(added);
}

// Keys a power of two apart, and more than fit the initial table.
TEST(LocalNumbers, GrowsAndKeepsNumbers) {
  for (const Index step : {Index{1}, Index{1} << 8, Index{1} << 15}) {
    LocalNumbers numbers;
    bool added = false;
    for (int round = 0; round < 3; ++round) {
      numbers.clear();
      for (Index i = 0; i < 2000; ++i) ASSERT_EQ(numbers.number(i * step, added), i);
      for (Index i = 0; i < 2000; ++i) ASSERT_EQ(numbers.find(i * step), i);
      EXPECT_EQ(numbers.size(), 2000u);
    }
  }
}

}  // namespace
}  // namespace tetwright::local_numbers_test

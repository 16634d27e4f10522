// SPDX-License-Identifier: Apache-2.0
#include "common/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace tetwright::random_test {
namespace {

// Results are reproducible on all machines only with these numbers: they must never change.
TEST(Random, KnownNumbers) {
  Random random(1234567);  // reference values of Vigna's splitmix64.c
  EXPECT_EQ(random.next(), 6457827717110365317u);
  EXPECT_EQ(random.next(), 3203168211198807973u);
  EXPECT_EQ(random.next(), 9817491932198370423u);
}

TEST(Random, StaysInRangeAndFillsIt) {
  Random random(2);
  std::array<int, 7> seen{};
  double low = 1, high = 0;
  for (int i = 0; i < 70000; ++i) {
    ++seen[random.below(7)];
    const double u = random.uniform();
    low = std::min(low, u);
    high = std::max(high, u);
  }
  for (int n : seen) EXPECT_NEAR(n, 10000, 500);
  EXPECT_GE(low, 0);
  EXPECT_LT(low, 1e-3);
  EXPECT_LT(high, 1);
  EXPECT_GT(high, 1 - 1e-3);
}

TEST(Random, ShuffleIsAPermutationAndEveryPlaceIsReached) {
  std::array<std::array<int, 5>, 5> at{};
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    std::vector<int> items(5);
    std::iota(items.begin(), items.end(), 0);
    random.shuffle(std::span(items));
    for (int k = 0; k < 5; ++k) ++at[k][items[k]];
    std::sort(items.begin(), items.end());
    ASSERT_EQ(items, (std::vector<int>{0, 1, 2, 3, 4}));
  }
  for (const auto& row : at)
    for (int n : row) EXPECT_NEAR(n, 4000, 300);
}

TEST(Random, StreamsDiffer) {
  EXPECT_NE(Random(1, 0, 0).next(), Random(1, 0, 1).next());
  EXPECT_NE(Random(1, 0, 0).next(), Random(1, 1, 0).next());
  EXPECT_NE(Random(1, 0, 0).next(), Random(2, 0, 0).next());
  EXPECT_EQ(Random(1, 2, 3).next(), Random(1, 2, 3).next());
}

}  // namespace
}  // namespace tetwright::random_test

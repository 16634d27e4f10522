// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/morton.h"

#include <gtest/gtest.h>

#include "common/random.h"

namespace tetwright::morton_test {
namespace {

TEST(Morton, RoundTrip) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const std::array<int, 3> p{static_cast<int>(random.below(1 << 21)),
                               static_cast<int>(random.below(1 << 21)),
                               static_cast<int>(random.below(1 << 21))};
    EXPECT_EQ(morton_decode(morton_encode(p)), p);
  }
}

TEST(Morton, ParentIsThreeBitsUp) {
  EXPECT_EQ(morton_encode(1, 0, 0), 1u);
  EXPECT_EQ(morton_encode(0, 1, 0), 2u);
  EXPECT_EQ(morton_encode(0, 0, 1), 4u);
  EXPECT_EQ(morton_encode(13, 6, 9) >> 3, morton_encode(6, 3, 4));
}

}  // namespace
}  // namespace tetwright::morton_test

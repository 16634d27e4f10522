// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesher_input.h"

#include <gtest/gtest.h>

namespace tetwright::mesher_input_test {
namespace {

TEST(RegionSet, IsSortedAndHoldsFour) {
  RegionSet set;
  for (int r : {7, 2, 7, 9, 2}) EXPECT_TRUE(set.insert(static_cast<RegionIndex>(r)));
  EXPECT_EQ(std::vector<int>(set.begin(), set.end()), (std::vector<int>{2, 7, 9}));
  EXPECT_TRUE(set.insert(1));
  EXPECT_FALSE(set.insert(3));
  EXPECT_TRUE(set.insert(9));
  EXPECT_EQ(set.size(), 4);
  EXPECT_TRUE(set.contains(1));
  EXPECT_FALSE(set.contains(3));
}

}  // namespace
}  // namespace tetwright::mesher_input_test

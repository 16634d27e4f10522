// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/expected_time.h"

#include <gtest/gtest.h>

namespace tetwright::expected_time_test {
namespace {

TEST(ExpectedTime, GrowsWithDenseTetsTargetAndVoxels) {
  const double one = expected_seconds({.dense_tets = 1e6}, 1);
  EXPECT_DOUBLE_EQ(expected_seconds({.dense_tets = 3e6}, 1), 3 * one);
  EXPECT_GT(expected_seconds({.dense_tets = 1e6, .target_tets = 1e5}, 1), one);
  EXPECT_GT(expected_seconds({.dense_tets = 1e6, .voxels = 1e7}, 1), one);
}

TEST(ExpectedTime, FallsWithThreadsButNotInProportion) {
  const ExpectedWork work{.dense_tets = 2e7, .target_tets = 2e5, .voxels = 2e7};
  const double one = expected_seconds(work, 1), four = expected_seconds(work, 4);
  EXPECT_LT(four, one);
  EXPECT_GT(four, one / 4);
  EXPECT_LT(expected_seconds(work, 16), four);
}

TEST(ExpectedTime, NamesTetsTimeAndThreads) {
  EXPECT_EQ(expected_time_line({}, 1), "about 0 dense tets, which take about 1 s with 1 thread");
  const std::string line = expected_time_line({.dense_tets = 20.34e6, .target_tets = 2e5}, 2);
  EXPECT_NE(line.find("20 million dense tets"), std::string::npos) << line;
  EXPECT_NE(expected_time_line({.dense_tets = 3e7}, 2).find(" minutes with 2 threads"), std::string::npos);
  EXPECT_NE(expected_time_line({.dense_tets = 1e10}, 1).find(" hours "), std::string::npos);
  EXPECT_NE(expected_time_line({.dense_tets = 123456}, 1).find("120000 dense tets"), std::string::npos);
}

}  // namespace
}  // namespace tetwright::expected_time_test

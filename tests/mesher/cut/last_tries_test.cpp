// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/last_tries.h"

#include <gtest/gtest.h>

namespace tetwright::last_tries_test {
namespace {

TEST(LastTries, TellsWhatHasMovedSinceATry) {
  LastTries tries(3);
  EXPECT_FALSE(tries.tried(0));
  tries.record(0, 0, false);
  tries.record(1, 1, true);
  EXPECT_TRUE(tries.tried(0));
  EXPECT_FALSE(tries.tried(2));
  EXPECT_TRUE(tries.moved_since(1, 0));
  EXPECT_FALSE(tries.moved_since(0, 1));
  // A point that moved at its own try may move on.
  EXPECT_TRUE(tries.moved_since(1, 1));
  EXPECT_FALSE(tries.moved_since(0, 0));
}

TEST(LastTries, OrdersTheSweeps) {
  LastTries tries(2);
  tries.record(0, 0, true);
  tries.record(1, 1, false);
  tries.end_sweep(2);
  EXPECT_FALSE(tries.moved_since(0, 1));
  tries.record(0, 0, true);  // in the second sweep
  EXPECT_TRUE(tries.moved_since(0, 1));
  tries.record(1, 1, false);
  EXPECT_FALSE(tries.moved_since(0, 1));
}

}  // namespace
}  // namespace tetwright::last_tries_test

// SPDX-License-Identifier: Apache-2.0
#include "tetwright/loop_times.h"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>
#include <thread>

#include "common/parallel/counted_loop.h"
#include "tetwright/resources.h"

namespace tetwright::loop_times_test {
namespace {

void loop_of(std::size_t parts) {
  parallel_for(0, parts, 1, [](std::size_t, std::size_t) {});
}

TEST(LoopTimes, ALoopCannotUseMoreCoresThanItHasParts) {
  static_assert(LoopTimes::cores == std::array<unsigned, 4>{2, 4, 16, 64});
  LoopTimes times;
  times.add(12, 3);
  EXPECT_EQ(times.loops, 1u);
  EXPECT_DOUBLE_EQ(times.seconds, 12);
  EXPECT_DOUBLE_EQ(times.on_cores[0], 8);  // one core does two parts
  EXPECT_DOUBLE_EQ(times.on_cores[1], 4);
  EXPECT_DOUBLE_EQ(times.on_cores[2], 4);
  EXPECT_DOUBLE_EQ(times.on_cores[3], 4);
  times.add(32, CountedLoop::divided_by_library);
  EXPECT_DOUBLE_EQ(times.on_cores[0], 8 + 16);
  EXPECT_DOUBLE_EQ(times.on_cores[3], 4 + 0.5);
  times.thread_seconds = 50;  // 6 of them serial
  EXPECT_DOUBLE_EQ(times.predicted(0), 6 + 8 + 16);
  EXPECT_DOUBLE_EQ(times.predicted(3), 6 + 4 + 0.5);
  LoopTimes twice = times;
  twice += times;
  EXPECT_DOUBLE_EQ(twice.thread_seconds, 100);
  EXPECT_DOUBLE_EQ(twice.seconds, 88);
  EXPECT_DOUBLE_EQ((twice - times).thread_seconds, 50);
  EXPECT_EQ((twice - times).loops, 2u);
  EXPECT_DOUBLE_EQ((twice - times).on_cores[1], times.on_cores[1]);
}

TEST(LoopTimes, NothingIsCountedUnlessAskedFor) {
  loop_of(5);
  EXPECT_EQ(loop_times().loops, 0u);
  const CountLoops count;
  std::thread([] { loop_of(5); }).join();
  EXPECT_EQ(loop_times().loops, 0u) << "of another thread";
}

TEST(LoopTimes, OutermostLoopsCountForAnyNumberOfThreads) {
  for (const unsigned threads : {1u, 3u}) {
    const ThreadLimit limit(threads);
    const CountLoops count;
    loop_of(4);
    loop_of(1);
    loop_of(0);
    EXPECT_EQ(loop_times().loops, 1u) << "one part is serial";
    parallel_chunks(2, [](std::size_t, unsigned) {
      loop_of(3);
      EXPECT_EQ(loop_times().loops, 0u);
    });
    EXPECT_EQ(loop_times().loops, 2u);
    parallel_for(0, 1, 1, [](std::size_t, std::size_t) { loop_of(3); });
    EXPECT_EQ(loop_times().loops, 3u) << "a loop within a part that is alone";
    {
      const CountedLoop library(CountedLoop::divided_by_library);
      loop_of(3);
    }
    EXPECT_EQ(loop_times().loops, 4u);
  }
}

TEST(LoopTimes, InnerCountsBelongToOuterOnes) {
  const CountLoops outer;
  loop_of(2);
  {
    const CountLoops inner;
    loop_of(2);
    loop_of(2);
    EXPECT_EQ(loop_times().loops, 2u);
  }
  EXPECT_EQ(loop_times().loops, 3u);
}

TEST(LoopTimes, CountingContinuesAfterAnException) {
  const CountLoops count;
  EXPECT_THROW(
      parallel_for(0, 2, 1, [](std::size_t, std::size_t) { throw std::runtime_error("a part failed"); }),
      std::runtime_error);
  loop_of(2);
  EXPECT_EQ(loop_times().loops, 2u);
}

}  // namespace
}  // namespace tetwright::loop_times_test

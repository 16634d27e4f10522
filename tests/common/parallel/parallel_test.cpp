// SPDX-License-Identifier: Apache-2.0
#include "tetwright/resources.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "common/random.h"

namespace tetwright::parallel_test {
namespace {

TEST(Parallel, ForVisitsEachItemOnce) {
  for (unsigned threads : {1u, 2u, 8u}) {
    const ThreadLimit limit(threads);
    EXPECT_EQ(thread_count(), threads);
    std::vector<int> visits(10007, 0);  // not atomic: the thread sanitizer detects overlapping parts
    parallel_for(3, visits.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(std::accumulate(visits.begin(), visits.end(), 0), 10004);
    EXPECT_EQ(visits[2], 0);
    EXPECT_EQ(*std::min_element(visits.begin() + 3, visits.end()), 1);
  }
}

TEST(Parallel, ChunksComeOnceAndInOrderWithOneThread) {
  {
    const ThreadLimit one(1);
    std::vector<std::size_t> order;
    parallel_chunks(5, [&](std::size_t chunk, unsigned worker) {
      EXPECT_EQ(worker, 0u);
      order.push_back(chunk);
    });
    EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  }
  const ThreadLimit eight(8);
  std::vector<int> visits(1000, 0);
  std::vector<int> of_worker(8, 0);  // a worker's data need no lock
  parallel_chunks(visits.size(), [&](std::size_t chunk, unsigned worker) {
    ++visits[chunk];
    ++of_worker[worker];
  });
  EXPECT_EQ(*std::min_element(visits.begin(), visits.end()), 1);
  EXPECT_EQ(*std::max_element(visits.begin(), visits.end()), 1);
  EXPECT_EQ(std::accumulate(of_worker.begin(), of_worker.end(), 0), 1000);
}

TEST(Parallel, SumHasTheSameBitsForAnyNumberOfThreads) {
  Random random(4);
  std::vector<double> values(20000);
  for (double& v : values) v = std::ldexp(random.uniform() - 0.5, static_cast<int>(random.below(60)));
  double first = 0;
  for (unsigned threads : {1u, 2u, 5u}) {
    const ThreadLimit limit(threads);
    const double sum = parallel_sum(0, values.size(), 100, [&](std::size_t begin, std::size_t end) {
      double part = 0;
      for (std::size_t i = begin; i < end; ++i) part += values[i];
      return part;
    });
    if (threads == 1) first = sum;
    EXPECT_EQ(sum, first);
  }
}

TEST(Parallel, AnExceptionArrivesAtTheCaller) {
  const ThreadLimit four(4);
  EXPECT_THROW(parallel_for(0, 1000, 1,
                            [](std::size_t begin, std::size_t) {
                              if (begin == 500) throw std::runtime_error("one part failed");
                            }),
               std::runtime_error);
  EXPECT_THROW(parallel_chunks(100,
                               [](std::size_t chunk, unsigned) {
                                 if (chunk == 50) throw std::runtime_error("one chunk failed");
                               }),
               std::runtime_error);
}

TEST(Parallel, NoMoreThreadsThanUseful) {
  EXPECT_GE(max_threads(), 16u);
  EXPECT_GE(max_threads(), hardware_threads());
  const ThreadLimit thousands(1000);
  EXPECT_EQ(thread_count(), std::min(1000u, max_threads()));
}

TEST(Parallel, LimitsNestAndEnd) {
  const unsigned before = thread_count();
  {
    const ThreadLimit three(3);
    EXPECT_EQ(thread_count(), 3u);
    {
      const ThreadLimit one(1);
      EXPECT_EQ(thread_count(), 1u);
    }
    EXPECT_EQ(thread_count(), 3u);
  }
  EXPECT_EQ(thread_count(), before);
}

TEST(Parallel, LimitsBelongToTheThreadThatSetsThem) {
  const ThreadLimit three(3);
  unsigned there = 0, within = 0;
  std::thread([&] {
    there = thread_count();
    with_threads(1, [&] { within = thread_count(); });
  }).join();
  EXPECT_EQ(there, hardware_threads());
  EXPECT_EQ(within, 1u);
  EXPECT_EQ(thread_count(), 3u);
  // Loop bodies have the limit of the thread that started the loop.
  std::vector<unsigned> counts(100, 0);
  parallel_for(0, counts.size(), 1, [&](std::size_t begin, std::size_t) { counts[begin] = thread_count(); });
  EXPECT_EQ(std::count(counts.begin(), counts.end(), 3u), 100);
  EXPECT_THROW(with_threads(2, [] { throw std::runtime_error("work"); }), std::runtime_error);
  EXPECT_EQ(thread_count(), 3u);
}

}  // namespace
}  // namespace tetwright::parallel_test

// SPDX-License-Identifier: Apache-2.0
#include "common/parallel/parallel_sort.h"

#include <gtest/gtest.h>

#include "common/random.h"

namespace tetwright::parallel_sort_test {
namespace {

TEST(ParallelSort, AgreesWithStdSort) {
  for (unsigned threads : {1u, 2u, 5u}) {
    const ThreadLimit limit(threads);
    for (std::size_t n : {0u, 1u, 2u, 1000u, 8192u, 8193u, 50000u, 131071u}) {
      Random random(n);
      std::vector<std::uint32_t> items(n);
      for (auto& i : items) i = random.below(20000);
      auto expected = items;
      std::sort(expected.begin(), expected.end());
      parallel_sort(items);
      EXPECT_EQ(items, expected) << n;
      expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
      parallel_sort_unique(items);
      EXPECT_EQ(items, expected) << n;
    }
  }
}

TEST(ParallelCollect, KeepsTheOrder) {
  const ThreadLimit limit(3);
  const auto even = parallel_collect<std::size_t>(
      10, 1000, 7, [](std::size_t begin, std::size_t end, std::vector<std::size_t>& out) {
        for (std::size_t i = begin; i < end; ++i)
          if (i % 2 == 0) out.push_back(i);
      });
  ASSERT_EQ(even.size(), 495u);
  for (std::size_t k = 0; k < even.size(); ++k) EXPECT_EQ(even[k], 10 + 2 * k);
}

}  // namespace
}  // namespace tetwright::parallel_sort_test

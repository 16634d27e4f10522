// SPDX-License-Identifier: Apache-2.0
#include "common/parallel/bucket_sort.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/random.h"

namespace tetwright::bucket_sort_test {
namespace {

TEST(BucketSort, ItemsOfAKeyKeepTheirOrder) {
  struct Size {
    std::size_t sources, keys;
  };
  // The largest have several chunks of sources and several blocks of keys.
  for (const auto& [sources, keys] :
       {Size{0, 1}, Size{5, 1}, Size{100, 7}, Size{70000, 3}, Size{100000, 40000}}) {
    Random random(sources);
    std::vector<std::uint32_t> key_of(2 * sources);
    for (std::uint32_t& key : key_of) key = random.below(static_cast<std::uint32_t>(keys));
    // Source s has the items 2 s and 2 s + 1; every third source has none.
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < key_of.size(); ++i)
      if (i / 2 % 3 != 0) expected.push_back(i);
    std::stable_sort(expected.begin(), expected.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return key_of[a] < key_of[b]; });
    for (const unsigned threads : {1u, 3u}) {
      const ThreadLimit limit(threads);
      std::vector<std::uint32_t> starts, items;
      bucket_sort(
          sources, keys,
          [&](std::size_t s, const auto& emit) {
            if (s % 3 == 0) return;
            for (std::size_t i = 2 * s; i < 2 * s + 2; ++i) emit(key_of[i], static_cast<std::uint32_t>(i));
          },
          [&](std::uint32_t item) { return std::size_t{key_of[item]}; }, starts, items);
      EXPECT_EQ(items, expected);
      ASSERT_EQ(starts.size(), keys + 1);
      EXPECT_EQ(starts[0], 0u);
      EXPECT_EQ(starts[keys], expected.size());
      for (std::size_t k = 0; k < keys; ++k)
        for (std::uint32_t i = starts[k]; i < starts[k + 1]; ++i) ASSERT_EQ(key_of[items[i]], k);
    }
  }
}

}  // namespace
}  // namespace tetwright::bucket_sort_test

// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/projection_tree.h"

#include <utility>

#include "common/geometry/morton.h"
#include "common/parallel/parallel_sort.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

constexpr std::size_t leaf_items = 4;
constexpr std::size_t key_grain = 4096;

}  // namespace

ProjectionTree::ProjectionTree(std::vector<Vec3> points, std::vector<Item> items)
    : points_(std::move(points)), items_(std::move(items)) {
  if (items_.empty()) return;
  Vec3 low = points_.front(), high = low;
  for (const Vec3& p : points_) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const MortonGrid grid(low, high);
  struct Key {
    std::uint64_t morton;
    std::uint32_t item;
  };
  std::vector<Key> keys(items_.size());
  parallel_for(0, keys.size(), key_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& c = items_[i].corners;
      keys[i] = {grid.key((points_[c[0]] + points_[c[1]] + points_[c[2]]) / 3),
                 static_cast<std::uint32_t>(i)};
    }
  });
  parallel_sort(keys, [](const Key& a, const Key& b) {
    return a.morton != b.morton ? a.morton < b.morton : a.item < b.item;
  });
  // Items move along the cycles of the permutation, since a copy of them may take gigabytes.
  for (std::uint32_t start = 0; start < keys.size(); ++start) {
    if (keys[start].item == start) continue;
    const Item first = items_[start];
    std::uint32_t to = start;
    while (true) {
      const std::uint32_t from = std::exchange(keys[to].item, to);
      if (from == start) break;
      items_[to] = items_[from];
      to = from;
    }
    items_[to] = first;
  }
  std::vector<Key>().swap(keys);

  tree_ = BoxTree(items_.size(), leaf_items, [&](std::size_t i) {
    Box3 box;
    for (Index corner : items_[i].corners) box.add(points_[corner]);
    return box;
  });
}

}  // namespace tetwright

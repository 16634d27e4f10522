// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/box_tree.h"

#include <numeric>

#include "common/error.h"
#include "common/geometry/morton.h"
#include "common/parallel/parallel.h"
#include "common/parallel/parallel_sort.h"

namespace tetwright {

namespace {

constexpr std::size_t node_grain = 256;   ///< leaves for each task of a parallel loop
constexpr std::size_t item_grain = 4096;  ///< items for each task
/// Larger ranges are halved by one thread, smaller ones in parallel.
constexpr std::size_t parallel_below = 1 << 14;

}  // namespace

BoxTree::BoxTree(std::size_t count, std::size_t leaf_size, const std::function<Box3(std::size_t)>& box_at)
    : leaf_size_(leaf_size) {
  TETWRIGHT_CHECK(leaf_size > 0 && count < no_index);
  if (count == 0) return;
  nodes_.resize(2 * leaf_count(count, leaf_size) - 1);
  std::vector<std::uint32_t> leaves;
  leaves.reserve(leaf_count(count, leaf_size));
  struct Part {
    std::size_t node, begin, end;
  };
  std::vector<Part> stack{{0, 0, count}};
  while (!stack.empty()) {
    const auto [k, begin, end] = stack.back();
    stack.pop_back();
    const std::size_t below = leaf_count(end - begin, leaf_size);
    Node& node = nodes_[k];
    node.next = static_cast<std::uint32_t>(k + 2 * below - 1);
    node.begin = static_cast<std::uint32_t>(begin);
    node.end = static_cast<std::uint32_t>(end);
    if (below == 1) {
      leaves.push_back(static_cast<std::uint32_t>(k));
      continue;
    }
    const std::size_t middle = begin + below / 2 * leaf_size;
    stack.push_back({k + 2 * (below / 2), middle, end});
    stack.push_back({k + 1, begin, middle});
  }
  parallel_for(0, leaves.size(), node_grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t l = first; l < last; ++l) {
      Node& leaf = nodes_[leaves[l]];
      for (std::size_t i = leaf.begin; i < leaf.end; ++i) leaf.box.add(box_at(i));
    }
  });
  for (std::size_t k = nodes_.size(); k-- > 0;) {
    if (is_leaf(nodes_[k])) continue;
    nodes_[k].box.add(nodes_[k + 1].box);
    nodes_[k].box.add(nodes_[nodes_[k + 1].next].box);
  }
}

std::vector<Index> morton_order(std::span<const Box3> boxes) {
  Box3 whole;
  for (const Box3& box : boxes) whole.add(box);
  struct Key {
    MortonKey morton;
    Index item;
  };
  std::vector<Key> keys(boxes.size());
  if (boxes.empty()) return {};
  const MortonGrid grid(whole.low, whole.high);
  parallel_for(0, keys.size(), item_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      keys[i] = {grid.key(boxes[i].low + (boxes[i].high - boxes[i].low) / 2), static_cast<Index>(i)};
  });
  parallel_sort(keys, [](const Key& a, const Key& b) {
    return a.morton != b.morton ? a.morton < b.morton : a.item < b.item;
  });
  std::vector<Index> order(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].item;
  return order;
}

std::vector<Index> median_order(std::span<const Box3> boxes, std::span<const Vec3> centres,
                                std::size_t leaf_size) {
  std::vector<Index> order(centres.size());
  std::iota(order.begin(), order.end(), Index{0});
  if (order.empty()) return order;
  using Range = BoxTree::Range;
  const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto halve = [&](const Range& range, std::vector<Range>& parts) {
    const std::size_t leaves = BoxTree::leaf_count(range.end - range.begin, leaf_size);
    if (leaves == 1) {
      std::sort(at(range.begin), at(range.end));
      return;
    }
    Box3 box;
    for (std::size_t i = range.begin; i < range.end; ++i) box.add(boxes[order[i]]);
    Eigen::Index axis;
    (box.high - box.low).maxCoeff(&axis);
    const std::size_t middle = range.begin + leaves / 2 * leaf_size;
    std::nth_element(at(range.begin), at(middle), at(range.end), [&](Index a, Index b) {
      return centres[a][axis] != centres[b][axis] ? centres[a][axis] < centres[b][axis] : a < b;
    });
    parts.push_back({middle, range.end});
    parts.push_back({range.begin, middle});
  };
  std::vector<Range> open{{0, order.size()}}, small;
  while (!open.empty()) {
    const Range range = open.back();
    open.pop_back();
    if (range.end - range.begin < parallel_below)
      small.push_back(range);
    else
      halve(range, open);
  }
  parallel_for(0, small.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      for (std::vector<Range> stack{small[k]}; !stack.empty();) {
        const Range range = stack.back();
        stack.pop_back();
        halve(range, stack);
      }
  });
  return order;
}

}  // namespace tetwright

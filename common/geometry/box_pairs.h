// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "common/geometry/box_tree.h"
#include "common/parallel/parallel_sort.h"

namespace tetwright {

/// Pairs of boxes that intersect and for which `accepts(first, second)` holds, each with the smaller index
/// first, ascending. `accepts` is called concurrently. O(n log n + intersecting pairs).
template <class Accepts>
std::vector<std::array<Index, 2>> intersecting_pairs(std::span<const Box3> boxes, const Accepts& accepts) {
  constexpr std::size_t leaf_size = 4, nodes_per_chunk = 512;
  const std::vector<Index> order = morton_order(boxes);
  const BoxTree tree(order.size(), leaf_size, [&](std::size_t i) { return boxes[order[i]]; });
  const std::span<const BoxTree::Node> nodes = tree.nodes();
  std::vector<std::array<Index, 2>> pairs = parallel_collect<std::array<Index, 2>>(
      0, nodes.size(), nodes_per_chunk,
      [&](std::size_t begin, std::size_t end, std::vector<std::array<Index, 2>>& found) {
        for (std::size_t k = begin; k < end; ++k) {
          if (!tree.is_leaf(nodes[k])) continue;
          tree.for_each_later_intersecting_leaf(k, [&](std::size_t l) {
            for (std::size_t i = nodes[k].begin; i < nodes[k].end; ++i)
              for (std::size_t j = std::max<std::size_t>(nodes[l].begin, i + 1); j < nodes[l].end; ++j) {
                const Index f = std::min(order[i], order[j]), g = std::max(order[i], order[j]);
                if (boxes[f].intersects(boxes[g]) && accepts(f, g)) found.push_back({f, g});
              }
          });
        }
      });
  parallel_sort(pairs);
  return pairs;
}

}  // namespace tetwright

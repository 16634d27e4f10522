// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// How points are grouped by space: in a volume, so that the order of two points depends on where they are
/// and on nothing else, as bricks require.
struct GroupsByBlock {
  /// By slot: one-to-one hash of the point's block.
  std::vector<std::uint64_t> blocks;

  bool joins(Index first, Index next, std::size_t) const { return blocks[first] == blocks[next]; }
  std::uint64_t hash(Index first, Index) const { return blocks[first]; }
};

/// How points are grouped by number, for surfaces.
struct GroupsOfNumbers {
  static constexpr std::size_t group_size = 16;  ///< points that one thread processes consecutively

  bool joins(Index, Index, std::size_t size) const { return size < group_size; }
  std::uint64_t hash(Index, Index item) const {
    std::uint32_t h = item * 0x9e3779b9u;
    h ^= h >> 15;
    h *= 0x85ebca6bu;
    return h ^ h >> 13;
  }
};

/// Splits a list into groups of neighbouring items of equal priority and sorts the groups within each
/// priority by a hash, so that groups processed concurrently rarely share points. \param priority must not
/// decrease along the list; within a priority, items are in Morton order \param slot slot(item) is the item's
/// point \return the indices at which groups start, and the end
template <class Priority, class Slot, class Grouping>
std::vector<std::size_t> scatter_groups(std::vector<Index>& items, Priority&& priority, Slot&& slot,
                                        const Grouping& grouping) {
  struct Group {
    std::size_t first, last;
    std::uint64_t hash;
  };
  std::vector<Group> groups;
  for (std::size_t i = 0, j; i < items.size(); i = j) {
    const Index first = slot(items[i]);
    for (j = i + 1; j < items.size() && grouping.joins(first, slot(items[j]), j - i) &&
                    priority(items[j]) == priority(items[i]);)
      ++j;
    groups.push_back({i, j, grouping.hash(first, items[i])});
  }
  for (std::size_t i = 0, j; i < groups.size(); i = j) {
    const auto now = priority(items[groups[i].first]);
    for (j = i; j < groups.size() && priority(items[groups[j].first]) == now;) ++j;
    std::sort(groups.begin() + static_cast<std::ptrdiff_t>(i),
              groups.begin() + static_cast<std::ptrdiff_t>(j),
              [](const Group& a, const Group& b) { return a.hash < b.hash; });
  }
  std::vector<Index> scattered_items;
  scattered_items.reserve(items.size());
  std::vector<std::size_t> starts{0};
  for (const Group& g : groups) {
    scattered_items.insert(scattered_items.end(), items.begin() + static_cast<std::ptrdiff_t>(g.first),
                           items.begin() + static_cast<std::ptrdiff_t>(g.last));
    starts.push_back(scattered_items.size());
  }
  items.swap(scattered_items);
  return starts;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/parallel/touched_memory.h"
#include "tetwright/resources.h"

namespace tetwright {

/// Sorts items by keys below `keys`, in parallel: first into blocks of neighbouring keys, then each block.
/// The items of a key keep their order. Needs, beside the result, a copy of the largest block for each
/// thread, and eight bytes for each block and 2^15 sources.
///
/// \param sources number of sources, each of which has any number of items
/// \param for_items `for_items(source, emit)` calls `emit(key, item)` for each item of a source, every time
/// the
///   same; called concurrently, twice for each source
/// \param key_of `key_of(item)` returns the key of an item; called concurrently
/// \param starts receives the bounds of the buckets: the items of key k are starts[k] to starts[k + 1]
/// \pre a Bound can hold the number of items
template <class Item, class Bound, class ForItems, class KeyOf>
void bucket_sort(std::size_t sources, std::size_t keys, const ForItems& for_items, const KeyOf& key_of,
                 std::vector<Bound>& starts, std::vector<Item>& items) {
  constexpr std::size_t chunk = 1 << 15;  // sources for each task: some nanoseconds each
  // At most 2^10 blocks, so that their ends stay in the cache, of 2^12 keys or more, which take 100 us or so.
  constexpr int max_blocks_log = 10, min_keys_log = 12;
  const int shift = std::max(min_keys_log, static_cast<int>(std::bit_width(keys)) - max_blocks_log);
  const std::size_t blocks = (keys >> shift) + 1, chunks = (sources + chunk - 1) / chunk;

  // Entry `c * blocks + b` is for items of chunk c in block b: first their number, then where the next one
  // goes.
  std::vector<std::size_t> next(chunks * blocks, 0);
  const auto for_items_of_chunks = [&](const auto& body) {
    parallel_for(0, chunks, 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t c = first; c < last; ++c) {
        std::size_t* const of_chunk = next.data() + c * blocks;
        for (std::size_t s = c * chunk; s < std::min(sources, (c + 1) * chunk); ++s)
          for_items(s, [&](std::size_t key, const Item& item) { body(of_chunk[key >> shift], item); });
      }
    });
  };
  for_items_of_chunks([](std::size_t& count, const Item&) { ++count; });
  std::vector<std::size_t> block_begins(blocks + 1);
  std::size_t total = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    block_begins[b] = total;
    for (std::size_t c = 0; c < chunks; ++c) total += std::exchange(next[c * blocks + b], total);
  }
  block_begins[blocks] = total;
  items.clear();
  reserve_touched(items, total);
  items.resize(total);
  for_items_of_chunks([&](std::size_t& at, const Item& item) { items[at++] = item; });

  starts.resize(keys + 1);
  starts[keys] = static_cast<Bound>(total);
  struct Workspace {
    std::vector<Bound> ends;
    std::vector<Item> unsorted;
  };
  std::vector<Workspace> workspaces(thread_count());
  parallel_chunks(blocks, [&](std::size_t b, unsigned worker) {
    auto& [ends, unsorted] = workspaces[worker];
    const std::size_t first_key = b << shift, last_key = std::min(keys, (b + 1) << shift);
    ends.assign(last_key - first_key, 0);
    unsorted.clear();
    for (std::size_t i = block_begins[b]; i < block_begins[b + 1]; ++i) {
      ++ends[key_of(items[i]) - first_key];
      unsorted.push_back(items[i]);
    }
    auto begin = static_cast<Bound>(block_begins[b]);
    for (std::size_t k = 0; k < ends.size(); ++k) {
      starts[first_key + k] = begin;
      begin += std::exchange(ends[k], begin);
    }
    for (const Item& item : unsorted) items[ends[key_of(item) - first_key]++] = item;
  });
}

}  // namespace tetwright

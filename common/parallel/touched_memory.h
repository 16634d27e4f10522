// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

/// Reserves memory for `size` items of an empty vector and writes to each of its pages, in parallel. The
/// system maps and clears a page when it is first written to, which for a large vector takes longer than
/// filling it; the thread that fills it would do that alone. \pre `items` is empty
template <class T>
void reserve_touched(std::vector<T>& items, std::size_t size) {
  constexpr std::size_t page = 4096;             // of all common systems, or a fraction of their pages
  constexpr std::size_t grain = page * 64;       // some ten microseconds
  constexpr std::size_t min_bytes = page * 256;  // smaller blocks are mostly reused, not mapped
  TETWRIGHT_CHECK(items.empty());
  items.reserve(size);
  const std::size_t bytes = size * sizeof(T);
  if (bytes < min_bytes) return;
  auto* const memory = reinterpret_cast<volatile unsigned char*>(items.data());
  parallel_for(0, bytes, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t at = begin; at < end; at += page) memory[at] = 0;
  });
}

}  // namespace tetwright

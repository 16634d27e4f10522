// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "tetwright/resources.h"

namespace tetwright {

/// Number of items of the sorted `a` among the first `count` of its merge with the sorted `b`, in which items
/// of `a` precede equivalent ones of `b`.
template <class Iterator, class Less>
std::ptrdiff_t merged_from_first(Iterator a, std::ptrdiff_t a_size, Iterator b, std::ptrdiff_t b_size,
                                 std::ptrdiff_t count, const Less& less) {
  std::ptrdiff_t low = std::max<std::ptrdiff_t>(0, count - b_size), high = std::min(count, a_size);
  while (low < high) {
    const std::ptrdiff_t middle = low + (high - low) / 2;
    if (less(b[count - middle - 1], a[middle]))
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

/// Sorts by `less`; the result does not depend on the number of threads. Needs memory for a second copy.
/// Parts are sorted and merged pair by pair; a merge is divided into pieces of equal length (merge path:
/// Odeh, Green, Mwassi, Shmueli & Birk 2012). \pre `less` is a total order in which equivalent items are
/// indistinguishable
template <class T, class Less = std::less<>>
void parallel_sort(std::vector<T>& items, const Less& less = {}) {
  constexpr std::size_t min_part = 1 << 13;  // starting a task for fewer items costs more than it saves
  constexpr std::size_t max_parts = 64;      // each doubling costs another pass over the items
  const std::size_t size = items.size(), part = std::max(min_part, (size + max_parts - 1) / max_parts);
  const auto at = [](std::vector<T>& of, std::size_t i) {
    return of.begin() + static_cast<std::ptrdiff_t>(i);
  };
  parallel_for(0, size, part, [&](std::size_t begin, std::size_t end) {
    std::sort(at(items, begin), at(items, end), less);
  });
  if (size <= part) return;
  std::vector<T> buffer(size);
  for (std::size_t width = part; width < size; width *= 2) {
    // `width` is a multiple of `part`, so each piece of the result belongs to a single pair.
    parallel_for(0, size, part, [&](std::size_t begin, std::size_t end) {
      const std::size_t pair = begin / (2 * width) * (2 * width), middle = std::min(size, pair + width),
                        pair_end = std::min(size, pair + 2 * width);
      const auto a = at(items, pair), b = at(items, middle);
      const auto from_a = [&](std::size_t count) {
        return merged_from_first(a, b - a, b, at(items, pair_end) - b, static_cast<std::ptrdiff_t>(count),
                                 less);
      };
      const std::ptrdiff_t a_begin = from_a(begin - pair), a_end = from_a(end - pair);
      std::merge(a + a_begin, a + a_end, b + (static_cast<std::ptrdiff_t>(begin - pair) - a_begin),
                 b + (static_cast<std::ptrdiff_t>(end - pair) - a_end), at(buffer, begin), less);
    });
    std::swap(items, buffer);
  }
}

/// Sorts and removes duplicates.
template <class T>
void parallel_sort_unique(std::vector<T>& items) {
  parallel_sort(items);
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

/// Calls `body(begin, end, out)` for parts of [begin, end) whose bounds depend only on `grain`, each with a
/// separate output vector.
/// \return the concatenation of the vectors in the order of the parts
template <class T, class Body>
std::vector<T> parallel_collect(std::size_t begin, std::size_t end, std::size_t grain, Body&& body) {
  if (begin >= end) return {};
  std::vector<std::vector<T>> parts((end - begin + grain - 1) / grain);
  parallel_for(0, parts.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      body(begin + k * grain, std::min(end, begin + (k + 1) * grain), parts[k]);
  });
  std::size_t size = 0;
  for (const std::vector<T>& part : parts) size += part.size();
  // Reserved memory is not resident until it is written, and each part is freed once it is copied.
  std::vector<T> all;
  all.reserve(size);
  for (std::vector<T>& part : parts) {
    all.insert(all.end(), part.begin(), part.end());
    std::vector<T>().swap(part);
  }
  return all;
}

}  // namespace tetwright

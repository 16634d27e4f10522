// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "tetwright/resources.h"

namespace tetwright {

/// Sorts by `less`; the result does not depend on the number of threads. Needs memory for a second copy.
/// \pre `less` is a total order in which equivalent items are indistinguishable
template <class T, class Less = std::less<>>
void parallel_sort(std::vector<T>& items, const Less& less = {}) {
  constexpr std::size_t min_chunk = 1 << 13;  // starting a task for fewer items costs more than it saves
  std::size_t chunk = std::max(min_chunk, items.size() / (4 * thread_count()) + 1);
  const auto bound = [&](std::size_t i) {
    return items.begin() + static_cast<std::ptrdiff_t>(std::min(items.size(), i));
  };
  const std::size_t chunks = (items.size() + chunk - 1) / chunk;
  parallel_for(0, chunks, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) std::sort(bound(c * chunk), bound((c + 1) * chunk), less);
  });
  if (chunks <= 1) return;
  std::vector<T> buffer(items.size());
  for (; chunk < items.size(); chunk *= 2) {
    const std::size_t pairs = (items.size() + 2 * chunk - 1) / (2 * chunk);
    parallel_for(0, pairs, 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t c = first; c < last; ++c)
        std::merge(bound(2 * c * chunk), bound((2 * c + 1) * chunk), bound((2 * c + 1) * chunk),
                   bound((2 * c + 2) * chunk), buffer.begin() + static_cast<std::ptrdiff_t>(2 * c * chunk),
                   less);
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

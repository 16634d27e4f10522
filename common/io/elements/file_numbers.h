// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// Maps the numbers of a file's nodes or elements, which need be neither dense nor sorted, to indices: 0, 1,
/// ... in the order of add().
class FileNumbers {
 public:
  void add(std::int64_t number) {
    dense_ = dense_ && number == std::ssize(numbers_) + 1;
    numbers_.emplace_back(number, static_cast<Index>(numbers_.size()));
  }
  std::size_t size() const { return numbers_.size(); }
  /// Prepares find(), after the last add().
  /// \return a number that was added twice, if there is one
  std::optional<std::int64_t> sort() {
    if (dense_) return std::nullopt;
    std::sort(numbers_.begin(), numbers_.end());
    const auto twice = std::adjacent_find(numbers_.begin(), numbers_.end(),
                                          [](const auto& a, const auto& b) { return a.first == b.first; });
    return twice == numbers_.end() ? std::nullopt : std::optional(twice->first);
  }
  /// Index of a number; no_index if it was not added.
  Index find(std::int64_t number) const {
    if (dense_)
      return number >= 1 && number <= std::ssize(numbers_) ? static_cast<Index>(number - 1) : no_index;
    const auto at = std::lower_bound(numbers_.begin(), numbers_.end(), number,
                                     [](const auto& a, std::int64_t b) { return a.first < b; });
    return at != numbers_.end() && at->first == number ? at->second : no_index;
  }

 private:
  std::vector<std::pair<std::int64_t, Index>> numbers_;
  bool dense_ = true;
};

}  // namespace tetwright

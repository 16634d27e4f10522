// SPDX-License-Identifier: Apache-2.0
#include "tools/app/nearest_word.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace tetwright {

std::size_t typing_errors(std::string_view a, std::string_view b) {
  const std::size_t columns = b.size() + 1;
  // errors[i * columns + j]: typing errors between the first i characters of a and the first j of b.
  std::vector<std::size_t> errors((a.size() + 1) * columns);
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      std::size_t& here = errors[i * columns + j];
      if (i == 0 || j == 0) {
        here = i + j;
        continue;
      }
      const auto at = [&](std::size_t back_i, std::size_t back_j) {
        return errors[(i - back_i) * columns + (j - back_j)];
      };
      here = std::min({at(1, 0) + 1, at(0, 1) + 1, at(1, 1) + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) here = std::min(here, at(2, 2) + 1);
    }
  return errors.back();
}

std::string nearest_word(std::string_view typed, std::span<const std::string> words) {
  // Bounds the cost, since arguments may have any length. No known name is longer.
  constexpr std::size_t max_compared = 64;
  std::string nearest;
  std::size_t min_errors = std::numeric_limits<std::size_t>::max();
  for (const std::string& word : words) {
    const std::size_t errors = typing_errors(typed.substr(0, max_compared), word);
    if (errors >= min_errors) continue;
    min_errors = errors;
    nearest = word;
  }
  return nearest;
}

}  // namespace tetwright

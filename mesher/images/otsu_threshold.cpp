// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "mesher/tuning/image_tuning.h"
#include "tetwright/error.h"
#include "tetwright/image_input.h"

namespace tetwright {

double otsu_threshold(const std::vector<float>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  TETWRIGHT_CHECK(low != high && *low < *high);
  constexpr std::size_t bins = ImageTuning::histogram_bins;
  const double first = *low, width = (static_cast<double>(*high) - first) / bins;
  std::vector<std::uint64_t> counts(bins, 0);
  for (const float value : values) {
    const auto bin = static_cast<std::size_t>((static_cast<double>(value) - first) / width);
    ++counts[std::min(bin, bins - 1)];
  }
  double total = 0;
  for (std::size_t b = 0; b < bins; ++b) total += static_cast<double>(counts[b]) * static_cast<double>(b);
  const auto n = static_cast<double>(values.size());
  double below = 0, sum_below = 0, largest = -1;
  // Empty bins between two classes are equally good.
  std::size_t begin = 1, end = 1;
  for (std::size_t b = 1; b < bins; ++b) {
    below += static_cast<double>(counts[b - 1]);
    sum_below += static_cast<double>(counts[b - 1]) * static_cast<double>(b - 1);
    const double above = n - below;
    if (above <= 0) break;
    const double apart = sum_below / below - (total - sum_below) / above;
    const double variance = below * above * apart * apart;
    if (variance > largest) {
      largest = variance;
      begin = end = b;
    } else if (counts[b - 1] == 0 && end + 1 == b) {
      end = b;
    }
  }
  return first + 0.5 * width * static_cast<double>(begin + end);
}

}  // namespace tetwright

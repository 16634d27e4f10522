// SPDX-License-Identifier: Apache-2.0
#include "mesher/images/image_smoothing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesher/tuning/image_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Weights at distances 0, 1, ..., not normalised.
std::vector<double> gaussian_kernel(double deviation) {
  std::vector<double> weights;
  const int reach = std::max(1, static_cast<int>(std::ceil(ImageTuning::kernel_reach * deviation)));
  // exp(-x) by squaring a short series, since libm's differs between machines.
  for (int d = 0; d <= reach; ++d) {
    const double x = 0.5 * d * d / (deviation * deviation);
    // Beyond that the weight is below the rounding of the sum, and the series would not converge.
    constexpr double negligible = 40;
    if (x > negligible) break;
    constexpr int squarings = 10;
    const double small = std::ldexp(-x, -squarings);
    double e = 1 + small * (1 + small / 2 * (1 + small / 3 * (1 + small / 4)));
    for (int i = 0; i < squarings; ++i) e *= e;
    weights.push_back(e);
  }
  return weights;
}

/// Convolves one line of `n` values that are `step` apart.
void smooth_line(const std::vector<double>& kernel, float* values, std::size_t step, int n,
                 std::vector<double>& line) {
  line.resize(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i)
    line[static_cast<std::size_t>(i)] = static_cast<double>(values[static_cast<std::size_t>(i) * step]);
  const int reach = static_cast<int>(kernel.size()) - 1;
  for (int i = 0; i < n; ++i) {
    double sum = 0, weights = 0;
    for (int k = std::max(0, i - reach); k <= std::min(n - 1, i + reach); ++k) {
      const double weight = kernel[static_cast<std::size_t>(std::abs(k - i))];
      sum += weight * line[static_cast<std::size_t>(k)];
      weights += weight;
    }
    values[static_cast<std::size_t>(i) * step] = static_cast<float>(sum / weights);
  }
}

}  // namespace

void smooth_image(const VoxelIndex& size, double deviation, std::vector<float>& values,
                  const Progress* progress) {
  const std::vector<double> kernel = gaussian_kernel(deviation);
  const auto x = static_cast<std::size_t>(size[0]), y = static_cast<std::size_t>(size[1]),
             z = static_cast<std::size_t>(size[2]);
  const auto lines = [&](std::size_t count, std::size_t step, int n, const auto& first) {
    parallel_for(0, count, ImageGrains::lines, [&](std::size_t begin, std::size_t end) {
      if (progress) progress->throw_if_stopped();
      std::vector<double> line;
      for (std::size_t i = begin; i < end; ++i) smooth_line(kernel, &values[first(i)], step, n, line);
    });
  };
  lines(y * z, 1, size[0], [&](std::size_t i) { return i * x; });
  lines(x * z, x, size[1], [&](std::size_t i) { return i / x * x * y + i % x; });
  lines(x * y, x * y, size[2], [&](std::size_t i) { return i; });
}

std::vector<double> volume_keeping_thresholds(std::vector<float> before, const std::vector<float>& after,
                                              const std::vector<double>& thresholds) {
  std::vector<std::size_t> below;
  below.reserve(thresholds.size());
  for (const double threshold : thresholds)
    below.push_back(static_cast<std::size_t>(std::count_if(
        before.begin(), before.end(), [&](float v) { return static_cast<double>(v) < threshold; })));
  before = after;
  std::vector<double> moved;
  for (const std::size_t n : below) {
    // Thresholds divide the image: some values are below and some above.
    const auto at = before.begin() + static_cast<std::ptrdiff_t>(n);
    std::nth_element(before.begin(), at, before.end());
    const double upper = *at, lower = *std::max_element(before.begin(), at);
    moved.push_back(0.5 * (lower + upper));
  }
  return moved;
}

void keep_volumes(MaterialImage& image, const std::vector<BandSize>& sizes, const Progress* progress) {
  const std::size_t channels = image.channels().size(), n = image.channels().front().size();
  std::vector<double> offsets(channels, 0);
  std::vector<float> lacks;
  for (int round = 0; round < ImageTuning::volume_rounds; ++round) {
    bool changed = false;
    for (std::size_t c = 0; c < channels; ++c) {
      if (progress) progress->throw_if_stopped();
      const auto wanted = static_cast<std::size_t>(sizes[c + 1].voxels);
      if (wanted == 0 || wanted == n) continue;
      // How much the channel lacks to be the largest.
      lacks.resize(n);
      parallel_for(0, n, ImageGrains::voxels, [&](std::size_t begin, std::size_t end) {
        std::vector<double> local(image.bands());
        const std::vector<std::uint8_t> none_lost(image.bands(), 0);
        for (std::size_t i = begin; i < end; ++i) {
          image.potentials(i, none_lost, local);
          double others = HUGE_VAL;
          for (std::size_t b = 0; b < local.size(); ++b)
            if (b != c + 1) others = std::min(others, local[b]);
          lacks[i] = static_cast<float>(local[c + 1] - others);
        }
      });
      const auto has = static_cast<std::size_t>(
          std::count_if(lacks.begin(), lacks.end(), [](float lack) { return lack <= 0; }));
      const double off = static_cast<double>(has > wanted ? has - wanted : wanted - has);
      if (off <= ImageTuning::volume_tolerance * static_cast<double>(wanted)) continue;
      const auto at = lacks.begin() + static_cast<std::ptrdiff_t>(wanted);
      std::nth_element(lacks.begin(), at, lacks.end());
      const double upper = *at, lower = *std::max_element(lacks.begin(), at);
      offsets[c] += 0.5 * (lower + upper);
      changed = true;
      image.set_offsets(offsets);
    }
    if (!changed) break;
  }
}

}  // namespace tetwright

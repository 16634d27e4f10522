// SPDX-License-Identifier: Apache-2.0

// Measurements of LabelSmoother: volumes of labels, and faces between their voxels.

#include <algorithm>
#include <cmath>

#include "mesher/labels/label_smoothing.h"
#include "mesher/tuning/label_tuning.h"

namespace tetwright {

namespace {

using Smoothing = LabelTuning::Smoothing;

float mix(float a, float b, float share) { return a + share * (b - a); }

/// Trilinear interpolation in a unit cell between the values at its corners.
float value_at(const std::array<float, 8>& c, const std::array<float, 3>& at) {
  return mix(mix(mix(c[0], c[1], at[0]), mix(c[2], c[3], at[0]), at[1]),
             mix(mix(c[4], c[5], at[0]), mix(c[6], c[7], at[0]), at[1]), at[2]);
}

/// The 1-norm of the gradient of the difference of two trilinear functions.
float slopes_at(const std::array<float, 8>& a, const std::array<float, 8>& b,
                const std::array<float, 3>& at) {
  std::array<float, 8> d;
  for (int k = 0; k < 8; ++k) d[k] = a[k] - b[k];
  const float x = mix(mix(d[1] - d[0], d[3] - d[2], at[1]), mix(d[5] - d[4], d[7] - d[6], at[1]), at[2]);
  const float y = mix(mix(d[2] - d[0], d[3] - d[1], at[0]), mix(d[6] - d[4], d[7] - d[5], at[0]), at[2]);
  const float z = mix(mix(d[4] - d[0], d[5] - d[1], at[0]), mix(d[6] - d[2], d[7] - d[3], at[0]), at[1]);
  return std::abs(x) + std::abs(y) + std::abs(z);
}

}  // namespace

std::vector<LabelSmoother::Contact> LabelSmoother::contacts() const {
  std::vector<std::uint32_t> pairs;
  for (int z = reach; z < reach + cells; ++z)
    for (int y = reach; y < reach + cells; ++y)
      for (int x = reach; x < reach + cells; ++x) {
        const int here = place(x, y, z);
        const std::array<int, 3> at{x - reach, y - reach, z - reach};
        bool inside = true;
        for (int a = 0; a < 3; ++a) inside &= at[a] >= low_[a] && at[a] < high_[a];
        if (!inside) continue;
        for (int a = 0; a < 3; ++a) {
          if (at[a] + 1 == high_[a]) continue;
          if (const auto [low, high] = std::minmax(own_[here], own_[here + steps[a]]); low != high)
            pairs.push_back(std::uint32_t{low} << 16 | high);
        }
      }
  std::sort(pairs.begin(), pairs.end());
  std::vector<Contact> found;
  for (std::size_t i = 0, j; i < pairs.size(); i = j) {
    for (j = i; j < pairs.size() && pairs[j] == pairs[i];) ++j;
    found.push_back({labels_[pairs[i] >> 16], labels_[pairs[i] & 0xffff], static_cast<std::uint32_t>(j - i)});
  }
  return found;
}

double LabelSmoother::volume_of(const std::array<int, 3>& part) const {
  double voxels = 1;
  for (int a = 0; a < 3; ++a) {
    int samples = 0;
    for (int i = part[a] * part_cells; i < (part[a] + 1) * part_cells; ++i)
      if (const auto [from, to] = samples_within(a, i); from < to) samples += to - from;
    voxels *= static_cast<double>(samples) / Smoothing::samples_along;
  }
  return voxels;
}

std::vector<double> LabelSmoother::shares(const std::array<int, 3>& part) const {
  std::vector<double> sums(labels_.size(), 0.0);
  std::vector<std::uint16_t> candidates;
  std::vector<std::array<float, 8>> corners;
  constexpr float sample_side = 1.0F / Smoothing::samples_along;
  constexpr double sample_volume =
      1.0 / (Smoothing::samples_along * Smoothing::samples_along * Smoothing::samples_along);
  std::array<int, 3> low, high;
  for (int a = 0; a < 3; ++a) {
    low[a] = reach + part[a] * part_cells;
    high[a] = low[a] + part_cells;
  }
  for (int z = low[2]; z < high[2]; ++z)
    for (int y = low[1]; y < high[1]; ++y)
      for (int x = low[0]; x < high[0]; ++x) {
        const std::array within{samples_within(0, x - reach), samples_within(1, y - reach),
                                samples_within(2, z - reach)};
        int count = 1;
        for (const auto& [from, to] : within) count *= std::max(0, to - from);
        if (count == 0) continue;
        std::array<int, 8> places;
        bool alike = true;
        for (int k = 0; k < 8; ++k) {
          places[k] = place(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2));
          alike &= own_[places[k]] == own_[places[0]];
        }
        if (alike) {
          sums[own_[places[0]]] += count * sample_volume;
          continue;
        }
        candidates.clear();
        for (int p : places)
          if (mixed_at_[p] >= 0)
            for (std::uint16_t l : labels_near(mixed_[mixed_at_[p]]))
              if (std::find(candidates.begin(), candidates.end(), l) == candidates.end())
                candidates.push_back(l);
        corners.resize(candidates.size());
        for (std::size_t l = 0; l < candidates.size(); ++l)
          for (int k = 0; k < 8; ++k) corners[l][k] = fields_[candidates[l]][places[k]];
        // Each sample represents the box around it, which is split if an interface crosses it.
        for (int i = 0; i < Smoothing::samples_along * Smoothing::samples_along * Smoothing::samples_along;
             ++i) {
          const std::array<int, 3> step{i % Smoothing::samples_along,
                                        i / Smoothing::samples_along % Smoothing::samples_along,
                                        i / (Smoothing::samples_along * Smoothing::samples_along)};
          std::array<float, 3> at;
          bool inside = true;
          for (int a = 0; a < 3; ++a) {
            at[a] = (static_cast<float>(step[a]) + 0.5F) * sample_side;
            inside &= step[a] >= within[a].first && step[a] < within[a].second;
          }
          if (!inside) continue;
          float first = HUGE_VALF, second = HUGE_VALF;
          std::size_t winner = 0, next = 0;
          for (std::size_t l = 0; l < candidates.size(); ++l) {
            const float d = value_at(corners[l], at);
            if (d < first)
              second = first, next = winner, first = d, winner = l;
            else if (d < second)
              second = d, next = l;
          }
          // The maximum change of the lead between the sample and the corners of its box.
          const float half = 0.5F * sample_side * slopes_at(corners[winner], corners[next], at);
          const double share = second - first < half ? 0.5 + 0.5 * (second - first) / half : 1.0;
          sums[candidates[winner]] += share * sample_volume;
          sums[candidates[next]] += (1 - share) * sample_volume;
        }
      }
  return sums;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "mesher/images/material_image.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "mesher/tuning/image_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

MaterialImage MaterialImage::nested(const VoxelIndex& size, std::vector<float> values,
                                    std::vector<double> thresholds) {
  MaterialImage image;
  image.size_ = size;
  image.channels_.push_back(std::move(values));
  image.thresholds_ = std::move(thresholds);
  return image;
}

MaterialImage MaterialImage::largest(const VoxelIndex& size, std::vector<std::vector<float>> channels,
                                     std::optional<double> outside) {
  MaterialImage image;
  image.size_ = size;
  image.nested_ = false;
  image.channels_ = std::move(channels);
  image.outside_ = outside;
  return image;
}

double MaterialImage::bytes() const {
  double all = 0;
  for (const std::vector<float>& channel : channels_)
    all += static_cast<double>(channel.size()) * sizeof(float);
  return all;
}

double MaterialImage::outside_value(std::size_t voxel) const {
  if (outside_) return *outside_;
  double sum = 0;
  // Offsets move interfaces without changing what is left for the outside.
  for (const std::vector<float>& channel : channels_) sum += static_cast<double>(channel[voxel]);
  return 1 - sum;
}

void MaterialImage::potentials(std::size_t voxel, std::span<double> out) const {
  if (nested_) {
    const double value = channel(0, voxel);
    double potential = 0;
    out[0] = 0;
    for (std::size_t k = 0; k < thresholds_.size(); ++k)
      out[k + 1] = potential += 2 * (thresholds_[k] - value);
    return;
  }
  for (std::size_t b = 0; b < bands(); ++b) out[b] = -band_value(b, voxel);
}

std::size_t MaterialImage::band(std::size_t voxel) const {
  if (nested_) {
    const auto above = std::upper_bound(thresholds_.begin(), thresholds_.end(), channel(0, voxel));
    return static_cast<std::size_t>(above - thresholds_.begin());
  }
  std::size_t best = 0;
  double largest = outside_value(voxel);
  for (std::size_t b = 1; b < bands(); ++b)
    if (const double value = channel(b - 1, voxel); value >= largest) largest = value, best = b;
  return best;
}

std::size_t MaterialImage::band_between(const std::array<std::size_t, 8>& corners,
                                        const std::array<double, 8>& weights,
                                        std::vector<double>& values) const {
  values.assign(bands(), 0);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (nested_)
      values[0] += weights[k] * channel(0, corners[k]);
    else
      for (std::size_t b = 0; b < values.size(); ++b) values[b] += weights[k] * band_value(b, corners[k]);
  }
  if (nested_) {
    const auto above = std::upper_bound(thresholds_.begin(), thresholds_.end(), values[0]);
    return static_cast<std::size_t>(above - thresholds_.begin());
  }
  return static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
}

double MaterialImage::contrast(std::size_t voxel, std::size_t a, std::size_t b) const {
  return nested_ ? channel(0, voxel) : 0.5 * (band_value(a, voxel) - band_value(b, voxel));
}

std::vector<double> volumes_of(const MaterialImage& image) {
  constexpr int along = ImageTuning::volume_samples_along;
  const VoxelIndex& size = image.size();
  const auto slices = static_cast<std::size_t>(size[2]);
  // Counts of samples in each slice.
  std::vector<std::vector<std::uint64_t>> counts(slices);
  parallel_for(0, slices, ImageGrains::slices, [&](std::size_t begin, std::size_t end) {
    std::vector<double> values;
    for (std::size_t z = begin; z < end; ++z) {
      std::vector<std::uint64_t>& count = counts[z];
      count.assign(image.bands(), 0);
      for (int y = 0; y < size[1]; ++y)
        for (int x = 0; x < size[0]; ++x) {
          const VoxelIndex at{x, y, static_cast<int>(z)};
          // The voxels around it, of which beyond the volume the closest one is taken.
          std::array<std::array<int, 3>, 3> near{};
          for (std::size_t a = 0; a < 3; ++a)
            for (int step = 0; step < 3; ++step)
              near[a][static_cast<std::size_t>(step)] = std::clamp(at[a] + step - 1, 0, size[a] - 1);
          const std::size_t own = image.band(image.voxel(x, y, at[2]));
          bool mixed = false;
          for (std::size_t k = 0; k < 27 && !mixed; ++k)
            mixed = image.band(image.voxel(near[0][k % 3], near[1][k / 3 % 3], near[2][k / 9])) != own;
          if (!mixed) {
            count[own] += along * along * along;
            continue;
          }
          for (int s = 0; s < along * along * along; ++s) {
            const std::array<int, 3> sample{s % along, s / along % along, s / (along * along)};
            std::array<std::size_t, 3> low;
            std::array<double, 3> share;
            for (std::size_t a = 0; a < 3; ++a) {
              const double offset = (sample[a] + 0.5) / along - 0.5;
              low[a] = offset < 0 ? 0 : 1;
              share[a] = offset < 0 ? offset + 1 : offset;
            }
            std::array<std::size_t, 8> corners;
            std::array<double, 8> weights;
            for (std::size_t k = 0; k < 8; ++k) {
              const std::array<std::size_t, 3> upper{k & 1, k >> 1 & 1, k >> 2};
              weights[k] = 1;
              for (std::size_t a = 0; a < 3; ++a) weights[k] *= upper[a] ? share[a] : 1 - share[a];
              corners[k] = image.voxel(near[0][low[0] + upper[0]], near[1][low[1] + upper[1]],
                                       near[2][low[2] + upper[2]]);
            }
            ++count[image.band_between(corners, weights, values)];
          }
        }
    }
  });
  std::vector<double> volumes(image.bands(), 0);
  for (const std::vector<std::uint64_t>& count : counts)
    for (std::size_t b = 0; b < volumes.size(); ++b)
      volumes[b] += static_cast<double>(count[b]) / (along * along * along);
  return volumes;
}

RegionGrid regions_of(const MaterialImage& image, std::span<const RegionIndex> regions) {
  RegionGrid grid(image.size());
  const VoxelIndex& size = image.size();
  const std::size_t slice = static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]);
  std::vector<RegionIndex> layer;
  for (int first = 0; first < size[2]; first += RegionGrid::side) {
    const int last = std::min(size[2], first + RegionGrid::side);
    layer.resize(static_cast<std::size_t>(last - first) * slice);
    const std::size_t start = static_cast<std::size_t>(first) * slice;
    parallel_for(0, layer.size(), ImageGrains::voxels, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) layer[i] = regions[image.band(start + i)];
    });
    grid.write_slices(first, layer);
  }
  return grid;
}

}  // namespace tetwright

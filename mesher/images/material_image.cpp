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

void MaterialImage::potentials(std::size_t voxel, std::span<const std::uint8_t> lost,
                               std::span<double> out) const {
  if (nested_) {
    const double value = channel(0, voxel);
    double potential = 0;
    out[0] = 0;
    for (std::size_t k = 0; k < thresholds_.size(); ++k) {
      if (!lost[k + 1]) potential += 2 * (thresholds_[k] - value);
      out[k + 1] = potential;
    }
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
  // Ties go to the last one, as in band().
  return static_cast<std::size_t>(values.rend() - std::max_element(values.rbegin(), values.rend()) - 1);
}

double MaterialImage::contrast(std::size_t voxel, std::size_t a, std::size_t b) const {
  return nested_ ? channel(0, voxel) : 0.5 * (band_value(a, voxel) - band_value(b, voxel));
}

namespace {

/// Counts samples of a voxel by band.
class VoxelSampler {
 public:
  static constexpr int along = ImageTuning::volume_samples_along, samples = along * along * along;

  explicit VoxelSampler(const MaterialImage& image) : image_(image) {}

  /// \param near indices along each axis of the voxel and those around it; beyond the volume the closest one
  void add(const std::array<std::array<int, 3>, 3>& near, std::vector<std::uint64_t>& counts) {
    for (int s = 0; s < samples; ++s) {
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
        corners[k] =
            image_.voxel(near[0][low[0] + upper[0]], near[1][low[1] + upper[1]], near[2][low[2] + upper[2]]);
      }
      ++counts[image_.band_between(corners, weights, values_)];
    }
  }

 private:
  const MaterialImage& image_;
  std::vector<double> values_;
};

/// Three slices of bands around one.
class BandSlices {
 public:
  explicit BandSlices(const RegionGrid& bands)
      : bands_(bands),
        size_(static_cast<std::size_t>(bands.size()[0]) * static_cast<std::size_t>(bands.size()[1])) {}

  void read(int z) {
    for (std::size_t k = 0; k < 3; ++k) {
      slices_[k].resize(size_);
      const int at = std::clamp(z + static_cast<int>(k) - 1, 0, bands_.size()[2] - 1);
      bands_.read_slices(at, at + 1, slices_[k]);
    }
  }
  RegionIndex at(int x, int y, std::size_t slice) const {
    return slices_[slice][static_cast<std::size_t>(y) * static_cast<std::size_t>(bands_.size()[0]) +
                          static_cast<std::size_t>(x)];
  }

 private:
  const RegionGrid& bands_;
  std::size_t size_;
  std::array<std::vector<RegionIndex>, 3> slices_;
};

}  // namespace

std::vector<BandSize> sizes_of(const MaterialImage& image, const RegionGrid& bands) {
  const VoxelIndex& size = image.size();
  const auto slices = static_cast<std::size_t>(size[2]);
  struct Counts {
    std::vector<std::uint64_t> voxels, samples;
  };
  std::vector<Counts> counts(slices);
  parallel_for(0, slices, ImageGrains::slices, [&](std::size_t begin, std::size_t end) {
    VoxelSampler sampler(image);
    BandSlices near_bands(bands);
    for (std::size_t z = begin; z < end; ++z) {
      near_bands.read(static_cast<int>(z));
      Counts& count = counts[z];
      count.voxels.assign(image.bands(), 0);
      count.samples.assign(image.bands(), 0);
      std::array<std::array<int, 3>, 3> near{};
      for (int y = 0; y < size[1]; ++y)
        for (int x = 0; x < size[0]; ++x) {
          const VoxelIndex at{x, y, static_cast<int>(z)};
          for (std::size_t a = 0; a < 3; ++a)
            for (int step = 0; step < 3; ++step)
              near[a][static_cast<std::size_t>(step)] = std::clamp(at[a] + step - 1, 0, size[a] - 1);
          const RegionIndex own = near_bands.at(x, y, 1);
          ++count.voxels[own];
          bool mixed = false;
          for (std::size_t k = 0; k < 27 && !mixed; ++k)
            mixed = near_bands.at(near[0][k % 3], near[1][k / 3 % 3], k / 9) != own;
          if (mixed)
            sampler.add(near, count.samples);
          else
            count.samples[own] += VoxelSampler::samples;
        }
    }
  });
  std::vector<BandSize> sizes(image.bands());
  for (const Counts& count : counts)
    for (std::size_t b = 0; b < sizes.size(); ++b) {
      sizes[b].voxels += count.voxels[b];
      sizes[b].volume += static_cast<double>(count.samples[b]) / VoxelSampler::samples;
    }
  return sizes;
}

RegionGrid bands_of(const MaterialImage& image) {
  RegionGrid grid(image.size());
  const VoxelIndex& size = image.size();
  const std::size_t slice = static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]);
  std::vector<RegionIndex> layer;
  for (int first = 0; first < size[2]; first += RegionGrid::side) {
    const int last = std::min(size[2], first + RegionGrid::side);
    layer.resize(static_cast<std::size_t>(last - first) * slice);
    const std::size_t start = static_cast<std::size_t>(first) * slice;
    parallel_for(0, layer.size(), ImageGrains::voxels, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) layer[i] = static_cast<RegionIndex>(image.band(start + i));
    });
    grid.write_slices(first, layer);
  }
  return grid;
}

}  // namespace tetwright

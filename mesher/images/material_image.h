// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "tetwright/label_source.h"
#include "tetwright/region_grid.h"

namespace tetwright {

/// An image whose values decide which region each point belongs to.
///
/// Each region has a *potential* at each voxel centre, which is linear in the values there; a point belongs
/// to the region of the smallest potential. Potentials that are interpolated trilinearly are therefore those
/// of the trilinear image, and the interface of two bands is exactly where the image has the threshold, or
/// where two channels are equal.
///
/// Immutable; functions may be called concurrently.
class MaterialImage {
 public:
  /// Bands nested by thresholds: band 0 has the values below the first one, band k those from
  /// thresholds[k - 1] on.
  /// \param thresholds ascending
  static MaterialImage nested(const VoxelIndex& size, std::vector<float> values,
                              std::vector<double> thresholds);
  /// A band for each channel, after band 0: where its channel is the largest. Band 0 has the points where no
  /// channel exceeds `outside`, or, without it, 1 - the sum of all channels.
  static MaterialImage largest(const VoxelIndex& size, std::vector<std::vector<float>> channels,
                               std::optional<double> outside);

  const VoxelIndex& size() const { return size_; }
  std::size_t bands() const { return nested_ ? thresholds_.size() + 1 : channels_.size() + 1; }
  const std::vector<std::vector<float>>& channels() const { return channels_; }
  std::vector<std::vector<float>> take_channels() && { return std::move(channels_); }
  std::span<const double> thresholds() const { return thresholds_; }
  const std::optional<double>& outside() const { return outside_; }
  /// Added to each channel's values before they are compared; empty: nothing.
  void set_offsets(std::vector<double> offsets) { offsets_ = std::move(offsets); }
  std::span<const double> offsets() const { return offsets_; }
  double bytes() const;

  std::size_t voxel(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_[0]) +
           static_cast<std::size_t>(x);
  }
  /// The potential of each band at a voxel. Half the difference of two bands' potentials has the slope of the
  /// image (nested), or half the slope of the difference of two channels.
  /// \param out bands() values
  /// \param lost by band: 1 if no voxel has it; of nested bands, the band below has its values, too, and its
  ///   potential is that of the band below
  void potentials(std::size_t voxel, std::span<const std::uint8_t> lost, std::span<double> out) const;
  /// The band of the smallest potential; ties go to the last one, so that a value equal to a threshold is
  /// inside.
  std::size_t band(std::size_t voxel) const;
  /// The band at a point between voxel centres.
  /// \param corners voxels around it
  /// \param weights of their values, which are interpolated
  /// \param values is overwritten
  std::size_t band_between(const std::array<std::size_t, 8>& corners, const std::array<double, 8>& weights,
                           std::vector<double>& values) const;
  /// The value whose gradient is that of half the difference of the potentials of two bands that meet, up to
  /// sign.
  double contrast(std::size_t voxel, std::size_t a, std::size_t b) const;

 private:
  double channel(std::size_t c, std::size_t voxel) const {
    return static_cast<double>(channels_[c][voxel]) + (offsets_.empty() ? 0 : offsets_[c]);
  }
  double outside_value(std::size_t voxel) const;
  double band_value(std::size_t band, std::size_t voxel) const {
    return band == 0 ? outside_value(voxel) : channel(band - 1, voxel);
  }

  VoxelIndex size_{};
  bool nested_ = true;
  std::vector<std::vector<float>> channels_;
  std::vector<double> thresholds_;
  std::optional<double> outside_;
  std::vector<double> offsets_;
};

/// The band of each voxel. Parallel.
RegionGrid bands_of(const MaterialImage& image);

/// Voxels and volume of a band.
struct BandSize {
  std::uint64_t voxels = 0;
  double volume = 0;  ///< between its interfaces, voxels
};

/// The size of each band. Volumes are counted at 4^3 points in each voxel that has a neighbour in another
/// band; voxels extend half a step beyond the outermost centres, where values continue. Parallel; the result
/// does not depend on the number of threads. \param bands of the voxels
std::vector<BandSize> sizes_of(const MaterialImage& image, const RegionGrid& bands);

}  // namespace tetwright

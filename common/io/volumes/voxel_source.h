// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "tetwright/image_volume.h"
#include "tetwright/label_source.h"

namespace tetwright {

/// A volume whose voxels are read box by box: as labels, or as values of an image with channels.
class VoxelSource : public LabelSource {
 public:
  std::int64_t channels() const { return channels_; }

  /// Reads the values of a channel in the half-open box of voxels from `low` to `high`. May be called
  /// concurrently.
  /// \param out receives the values, the first axis fastest
  /// \pre 0 <= low < high <= grid().size along each axis, and `out` has the size of the box
  /// \throws InputError as LabelSource::read() does, for values that are not finite 32-bit floats
  void read_values(const VoxelIndex& low, const VoxelIndex& high, std::int64_t channel,
                   std::span<float> out) const {
    read_box_of_values(low, high, channel, out);
  }

  /// Reads the values of several channels at once, as read_values() does.
  /// \param first the first channel
  /// \param out one for each channel from `first` on
  void read_channels(const VoxelIndex& low, const VoxelIndex& high, std::int64_t first,
                     std::span<const std::span<float>> out) const {
    read_box_of_channels(low, high, first, out);
  }

 protected:
  /// \param channels 1 if labels are read
  VoxelSource(LabelGrid grid, std::int64_t channels) : LabelSource(std::move(grid)), channels_(channels) {}
  virtual void read_box_of_values(const VoxelIndex& low, const VoxelIndex& high, std::int64_t channel,
                                  std::span<float> out) const = 0;
  /// Sources whose channels are stored together read them once.
  virtual void read_box_of_channels(const VoxelIndex& low, const VoxelIndex& high, std::int64_t first,
                                    std::span<const std::span<float>> out) const {
    for (const std::span<float>& values : out) read_box_of_values(low, high, first++, values);
  }

 private:
  std::int64_t channels_;
};

/// Reads all values of an image, decoding blocks in parallel: 4 bytes for each voxel and channel.
/// \param file file name for messages
/// \throws InputError and OutputError as read_all() does
ImageVolume read_all_values(const VoxelSource& source, const std::string& file);

}  // namespace tetwright

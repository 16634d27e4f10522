// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/raw_volume.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Bytes of voxels that are read and converted at a time.
constexpr std::size_t raw_piece_bytes = std::size_t{1} << 20;

class RawVolumeSource final : public VoxelSource {
 public:
  explicit RawVolumeSource(RawVolume volume)
      : VoxelSource(std::move(volume.grid), volume.channels.count),
        file_(volume.file),
        offset_(volume.offset),
        format_(volume.format),
        each_(voxel_bytes(format_.type)) {
    const std::uint64_t there = file_.size() > offset_ ? file_.size() - offset_ : 0;
    if (voxel_data_bytes(grid().size, format_.type, channels()) > there)
      throw InputError(file_.name() + ": " + needed_bytes(grid().size, format_.type, channels()) + "only " +
                       std::to_string(there) +
                       " follow the header; the file is truncated or its header is wrong");
    std::uint64_t stride = each_;
    for (std::size_t k = 0; k <= 3; ++k) {
      if (k == volume.channels.position) channel_stride_ = std::exchange(stride, stride * channels());
      if (k < 3) strides_[k] = std::exchange(stride, stride * static_cast<std::uint64_t>(grid().size[k]));
    }
  }

  VoxelIndex block() const override { return {grid().size[0], grid().size[1], 1}; }

 protected:
  void read_box(const VoxelIndex& low, const VoxelIndex& high, std::span<MaterialTag> out) const override {
    read_numbers<MaterialTag>(low, high, 0, {&out, 1});
  }
  void read_box_of_values(const VoxelIndex& low, const VoxelIndex& high, std::int64_t channel,
                          std::span<float> out) const override {
    read_numbers<float>(low, high, channel, {&out, 1});
  }
  void read_box_of_channels(const VoxelIndex& low, const VoxelIndex& high, std::int64_t first,
                            std::span<const std::span<float>> out) const override {
    if (channel_stride_ < strides_[0])
      read_numbers<float>(low, high, first, out);  // the numbers of a voxel follow each other
    else
      VoxelSource::read_box_of_channels(low, high, first, out);
  }

 private:
  /// Reads the channels from `first` on, whose numbers are between those of two voxels if there are several.
  template <class Value>
  void read_numbers(const VoxelIndex& low, const VoxelIndex& high, std::int64_t first,
                    std::span<const std::span<Value>> out) const {
    // Voxels at equal distances in the file: part of a row, rows, or slices.
    const VoxelIndex& size = grid().size;
    const auto joined = [&](std::size_t k) {
      return low[k] == 0 && high[k] == size[k] &&
             strides_[k + 1] == strides_[k] * static_cast<std::uint64_t>(size[k]);
    };
    const bool rows = joined(0), slices = rows && joined(1);
    const int y_end = rows ? low[1] + 1 : high[1], z_end = slices ? low[2] + 1 : high[2];
    std::size_t run = static_cast<std::size_t>(high[0] - low[0]);
    if (rows) run *= static_cast<std::size_t>(high[1] - low[1]);
    if (slices) run *= static_cast<std::size_t>(high[2] - low[2]);
    const std::size_t piece =
        std::min<std::size_t>(run, std::max<std::size_t>(raw_piece_bytes / strides_[0], 1));
    // From the first channel of a voxel to the end of the last one.
    const std::size_t voxel_bytes_read = (out.size() - 1) * channel_stride_ + each_;
    const ByteBuffer bytes((piece - 1) * strides_[0] + voxel_bytes_read);
    const std::uint64_t begin = offset_ + static_cast<std::uint64_t>(first) * channel_stride_;
    std::size_t written = 0;
    for (int z = low[2]; z < z_end; ++z)
      for (int y = low[1]; y < y_end; ++y)
        for (std::size_t done = 0; done < run; done += piece) {
          const std::size_t n = std::min(piece, run - done);
          file_.read(begin + offset_of(low[0], y, z) + done * strides_[0], bytes.data.get(),
                     (n - 1) * strides_[0] + voxel_bytes_read);
          for (std::size_t c = 0; c < out.size(); ++c) {
            const char* from = bytes.data.get() + c * channel_stride_;
            const std::size_t bad = convert_row(from, strides_[0], n, format_, out[c].data() + written);
            if (bad != n)
              throw InputError(
                  file_.name() + ": " +
                  bad_voxel<Value>(name_of({low[0], y, z}, done + bad, first + static_cast<std::int64_t>(c)),
                                   from + bad * strides_[0], format_));
          }
          written += n;
        }
  }

  std::uint64_t offset_of(int x, int y, int z) const {
    return static_cast<std::uint64_t>(z) * strides_[2] + static_cast<std::uint64_t>(y) * strides_[1] +
           static_cast<std::uint64_t>(x) * strides_[0];
  }

  /// The voxel `after` others of a row, of rows or of slices that begin with `first`.
  VoxelName name_of(const VoxelIndex& first, std::size_t after, std::int64_t channel) const {
    const auto nx = static_cast<std::uint64_t>(grid().size[0]),
               ny = static_cast<std::uint64_t>(grid().size[1]);
    const std::uint64_t voxel =
        (static_cast<std::uint64_t>(first[2]) * ny + static_cast<std::uint64_t>(first[1])) * nx +
        static_cast<std::uint64_t>(first[0]) + after;
    return {
        {static_cast<int>(voxel % nx), static_cast<int>(voxel / nx % ny), static_cast<int>(voxel / nx / ny)},
        channel,
        channels()};
  }

  FileRanges file_;
  std::uint64_t offset_;
  VoxelFormat format_;
  std::size_t each_;
  std::array<std::uint64_t, 3> strides_{};  ///< from one voxel to the next along each axis, bytes
  std::uint64_t channel_stride_ = 0;
};

}  // namespace

std::uint64_t offset_from_end(std::uint64_t file_size, const std::array<int, 3>& size, VoxelType type,
                              std::int64_t channels) {
  const std::uint64_t needed = voxel_data_bytes(size, type, channels);
  return needed < file_size ? file_size - needed : 0;
}

std::unique_ptr<VoxelSource> open_raw_volume(RawVolume volume) {
  // Beyond this limit offsets of voxels would not fit into 64 bits.
  const std::array<std::int64_t, 3> size{volume.grid.size[0], volume.grid.size[1], volume.grid.size[2]};
  (void)checked_size(size, volume.file, 0, max_source_voxels);
  check_channels(volume.channels.count, volume.grid.size, VoxelUse::image, volume.file, 0, max_source_voxels);
  return std::make_unique<RawVolumeSource>(std::move(volume));
}

std::unique_ptr<VoxelSource> find_raw_volume(const std::string& path, RawVolumeFinder find, VoxelUse use) {
  std::error_code error;
  // A pipe can only be read as a whole.
  if (!std::filesystem::is_regular_file(path, error)) return nullptr;
  const FileRanges file(path);
  const ByteBuffer head = file.head(max_header_bytes);
  std::optional<RawVolume> found = find({head.view(), file.size()}, path, use);
  return found ? open_raw_volume(std::move(*found)) : nullptr;
}

}  // namespace tetwright

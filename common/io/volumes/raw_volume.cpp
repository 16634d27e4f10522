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

class RawVolumeSource final : public LabelSource {
 public:
  explicit RawVolumeSource(RawVolume volume)
      : LabelSource(std::move(volume.grid)),
        file_(volume.file),
        offset_(volume.offset),
        format_(volume.format),
        each_(voxel_bytes(format_.type)) {
    const std::uint64_t there = file_.size() > offset_ ? file_.size() - offset_ : 0;
    if (voxel_data_bytes(grid().size, format_.type) > there)
      throw InputError(file_.name() + ": " + needed_bytes(grid().size, format_.type) + "only " +
                       std::to_string(there) +
                       " follow the header; the file is truncated or its header is wrong");
  }

  VoxelIndex block() const override { return {grid().size[0], grid().size[1], 1}; }

 protected:
  void read_box(const VoxelIndex& low, const VoxelIndex& high, std::span<MaterialTag> out) const override {
    // Voxels that follow each other in the file: part of a row, rows, or slices.
    const VoxelIndex& size = grid().size;
    const bool rows = low[0] == 0 && high[0] == size[0];
    const bool slices = rows && low[1] == 0 && high[1] == size[1];
    const int y_end = rows ? low[1] + 1 : high[1], z_end = slices ? low[2] + 1 : high[2];
    std::size_t run = static_cast<std::size_t>(high[0] - low[0]);
    if (rows) run *= static_cast<std::size_t>(high[1] - low[1]);
    if (slices) run *= static_cast<std::size_t>(high[2] - low[2]);
    const std::size_t piece = std::min(run, raw_piece_bytes / each_);
    const ByteBuffer bytes(piece * each_);
    MaterialTag* to = out.data();
    for (int z = low[2]; z < z_end; ++z)
      for (int y = low[1]; y < y_end; ++y)
        for (std::size_t done = 0; done < run; done += piece) {
          const std::size_t n = std::min(piece, run - done);
          read_run(index_of(low[0], y, z) + done, n, bytes.data.get(), to);
          to += n;
        }
  }

 private:
  std::uint64_t index_of(int x, int y, int z) const {
    const VoxelIndex& size = grid().size;
    return (static_cast<std::uint64_t>(z) * static_cast<std::uint64_t>(size[1]) +
            static_cast<std::uint64_t>(y)) *
               static_cast<std::uint64_t>(size[0]) +
           static_cast<std::uint64_t>(x);
  }

  void read_run(std::uint64_t first, std::size_t n, char* bytes, MaterialTag* to) const {
    file_.read(offset_ + first * each_, bytes, n * each_);
    const std::size_t bad = convert_row(bytes, each_, n, format_, to);
    if (bad == n) return;
    const std::uint64_t voxel = first + bad;
    const auto nx = static_cast<std::uint64_t>(grid().size[0]),
               ny = static_cast<std::uint64_t>(grid().size[1]);
    throw InputError(file_.name() + ": " +
                     bad_voxel({static_cast<int>(voxel % nx), static_cast<int>(voxel / nx % ny),
                                static_cast<int>(voxel / nx / ny)},
                               bytes + bad * each_, format_));
  }

  FileRanges file_;
  std::uint64_t offset_;
  VoxelFormat format_;
  std::size_t each_;
};

}  // namespace

std::uint64_t offset_from_end(std::uint64_t file_size, const std::array<int, 3>& size, VoxelType type) {
  const std::uint64_t needed = voxel_data_bytes(size, type);
  return needed < file_size ? file_size - needed : 0;
}

std::unique_ptr<LabelSource> open_raw_volume(RawVolume volume) {
  // Beyond this limit offsets of voxels would not fit into 64 bits.
  const std::array<std::int64_t, 3> size{volume.grid.size[0], volume.grid.size[1], volume.grid.size[2]};
  (void)checked_size(size, volume.file, 0, max_source_voxels);
  return std::make_unique<RawVolumeSource>(std::move(volume));
}

std::unique_ptr<LabelSource> find_raw_volume(const std::string& path, RawVolumeFinder find) {
  std::error_code error;
  // A pipe can only be read as a whole.
  if (!std::filesystem::is_regular_file(path, error)) return nullptr;
  const FileRanges file(path);
  const ByteBuffer head = file.head(max_header_bytes);
  std::optional<RawVolume> found = find({head.view(), file.size()}, path);
  return found ? open_raw_volume(std::move(*found)) : nullptr;
}

}  // namespace tetwright

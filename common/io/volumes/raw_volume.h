// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/io/encodings/file_ranges.h"
#include "common/io/volumes/voxel_data.h"
#include "common/io/volumes/voxel_source.h"

namespace tetwright {

/// A volume whose voxels are uncompressed in a file, the first axis fastest.
struct RawVolume {
  LabelGrid grid;
  std::string file;          ///< file with the voxels
  std::uint64_t offset = 0;  ///< of the first voxel, bytes
  VoxelFormat format;
  ChannelAxis channels = {};
};

/// Bytes of a header that are read. Headers with the names of hundreds of segments have some 100 kB.
inline constexpr std::size_t max_header_bytes = std::size_t{1} << 22;

/// The first bytes of a file, which may contain its whole header.
struct HeaderBytes {
  std::string_view bytes;
  std::uint64_t file_size = 0;
  bool whole_file() const { return bytes.size() == file_size; }
};

/// Finds the voxels of a volume from its header. The header's messages are those of the reader of the format.
/// \return std::nullopt if the voxels are compressed or text, or the header is longer than `head`
using RawVolumeFinder = std::optional<RawVolume> (*)(const HeaderBytes& head, const std::string& name,
                                                     VoxelUse use);

/// Offset of voxels that end at the end of their file, or 0 if the file is too short for them.
std::uint64_t offset_from_end(std::uint64_t file_size, const std::array<int, 3>& size, VoxelType type,
                              std::int64_t channels = 1);

/// Opens a volume that reads the ranges of its file that a box needs, and keeps nothing in memory.
/// \throws InputError if the file with the voxels cannot be read or is too short, or there are more than
///   max_source_voxels
std::unique_ptr<VoxelSource> open_raw_volume(RawVolume volume);

/// Finds and opens the volume.
/// \return null if `find` finds none, or `path` is not a regular file
std::unique_ptr<VoxelSource> find_raw_volume(const std::string& path, RawVolumeFinder find, VoxelUse use);

}  // namespace tetwright

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/formats/byte_source.h"
#include "common/formats/text_scanner.h"
#include "common/label_volume.h"

namespace tetwright {

/// What the formats of volumes share: the voxels' numbers as labels, and what a volume must be.

enum class VoxelType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

std::size_t voxel_bytes(VoxelType type);

/// How voxels are stored.
struct VoxelFormat {
  VoxelType type = VoxelType::uint8;
  bool swap = false;  ///< in the other byte order than this machine's
  /// A label is slope * number + intercept.
  double slope = 1, intercept = 0;
};

/// The sizes of a volume along its three axes. Throws InputError unless there are three, each is at least 1
/// and their product at most 2^31.
std::array<int, 3> checked_size(std::span<const std::int64_t> sizes, const std::string& file,
                                std::size_t line);

/// The labels of a body. Throws InputError if it is too short, or at the first voxel that is no whole number
/// of 32 bits. Takes memory for as many voxels as the body can hold, whatever `size` says.
std::vector<MaterialTag> read_voxels(ByteSource& body, const VoxelFormat& format,
                                     const std::array<int, 3>& size);

/// The same of numbers as text, with white space in between.
std::vector<MaterialTag> read_voxels_as_text(TextScanner& body, const std::array<int, 3>& size);

/// Throws InputError unless origin and directions are finite and the directions can be inverted.
void check_geometry(const LabelVolume& volume, const std::string& file);

}  // namespace tetwright

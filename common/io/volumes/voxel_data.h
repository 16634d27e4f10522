// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/encodings/byte_source.h"
#include "common/io/text/text_scanner.h"
#include "tetwright/label_source.h"

namespace tetwright {

// Functions shared by the volume formats: conversion of voxels to labels, and checks of a volume.

enum class VoxelType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

std::size_t voxel_bytes(VoxelType type);

/// Representation of a voxel in the file.
struct VoxelFormat {
  VoxelType type = VoxelType::uint8;
  bool swap = false;  ///< true: the byte order is not this machine's
  /// The label of a voxel is slope * stored number + intercept.
  double slope = 1, intercept = 0;
};

/// Maximum number of voxels of a volume that is read by boxes: their bytes are counted with 64 bits.
inline constexpr std::int64_t max_source_voxels = std::int64_t{1} << 59;

/// Checks the size of a volume, in voxels along each axis.
/// \throws InputError unless there are three axes, each size is at least 1 and less than 2^31, and their
///   product is at most `max_voxels`
std::array<int, 3> checked_size(std::span<const std::int64_t> sizes, const std::string& file,
                                std::size_t line, std::int64_t max_voxels = max_volume_voxels);

/// Bytes of all voxels of a volume.
std::uint64_t voxel_data_bytes(const std::array<int, 3>& size, VoxelType type);

/// Begin of a message on a body that is too short: "its 2 x 3 x 4 voxels of 2 bytes need 48 bytes, but ".
std::string needed_bytes(const std::array<int, 3>& size, VoxelType type);

/// Converts `n` numbers that are `step` bytes apart to labels.
/// \return the index of the first number that is not a label, or `n`
std::size_t convert_row(const char* from, std::size_t step, std::size_t n, const VoxelFormat& format,
                        MaterialTag* labels);

/// Message "voxel (1, 2, 3) has the value 0.5, ..." with the reason why the number at `from` is not a label.
std::string bad_voxel(const std::array<int, 3>& voxel, const char* from, const VoxelFormat& format);

/// Reads the labels of a body, the first axis fastest, converting in parallel. Allocates memory only for
/// voxels that the body can hold, whatever `size` promises.
/// \throws InputError if the body is too short, or at the first voxel whose label is not a 32-bit integer
std::vector<MaterialTag> read_voxels(ByteSource& body, const VoxelFormat& format,
                                     const std::array<int, 3>& size);

/// Reads labels written as text, separated by white space.
std::vector<MaterialTag> read_voxels_as_text(TextScanner& body, const std::array<int, 3>& size);

}  // namespace tetwright

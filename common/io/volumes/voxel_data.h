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
#include "tetwright/label_volume.h"

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

/// Checks the size of a volume, in voxels along each axis.
/// \throws InputError unless there are three axes, each size is at least 1 and their product is at most 2^31
std::array<int, 3> checked_size(std::span<const std::int64_t> sizes, const std::string& file,
                                std::size_t line);

/// Reads the labels of a body, the first axis fastest, converting in parallel. Allocates memory only for
/// voxels that the body can hold, whatever `size` promises.
/// \throws InputError if the body is too short, or at the first voxel whose label is not a 32-bit integer
std::vector<MaterialTag> read_voxels(ByteSource& body, const VoxelFormat& format,
                                     const std::array<int, 3>& size);

/// Reads labels written as text, separated by white space.
std::vector<MaterialTag> read_voxels_as_text(TextScanner& body, const std::array<int, 3>& size);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/encodings/byte_source.h"
#include "common/io/text/text_scanner.h"
#include "tetwright/label_source.h"

namespace tetwright {

// Functions shared by the volume formats: conversion of voxels to labels or to values of an image, and checks
// of a volume.

/// Purpose for which voxels are read. A label is a 32-bit integer, and a voxel has one. An image has finite
/// values of 32-bit floats, several for each voxel if it has channels.
enum class VoxelUse : std::uint8_t { labels, image };

/// For messages: "a volume of labels" or "an image".
std::string name_of_use(VoxelUse use);

/// End of a message on numbers that cannot be read: `labels`, the advice on labels, or that on images.
std::string numbers_to_save(VoxelUse use, const std::string& labels);

enum class VoxelType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float16, float32, float64 };

std::size_t voxel_bytes(VoxelType type);
/// The type called "uint8", "float32" and so on.
std::optional<VoxelType> voxel_type_called(std::string_view name);

/// Representation of a voxel in the file.
struct VoxelFormat {
  VoxelType type = VoxelType::uint8;
  bool swap = false;  ///< true: the byte order is not this machine's
  /// The label or value of a voxel is slope * stored number + intercept.
  double slope = 1, intercept = 0;
};

/// Axis of the numbers of each voxel.
struct ChannelAxis {
  std::int64_t count = 1;
  /// Number of spatial axes that vary faster: 0 if the numbers of a voxel follow each other, 3 if the
  /// channels do.
  std::size_t position = 3;
};

/// A voxel and its channel, for messages; the channel is 0 if there is only one.
struct VoxelName {
  std::array<int, 3> voxel{};
  std::int64_t channel = 0, channels = 1;
};

/// Maximum number of voxels of a volume that is read by boxes: their bytes are counted with 64 bits.
inline constexpr std::int64_t max_source_voxels = std::int64_t{1} << 59;

/// Maximum number of channels of an image. Each has an array of its own; time series have some thousand.
inline constexpr std::int64_t max_channels = std::int64_t{1} << 16;

/// Checks the size of a volume, in voxels along each axis.
/// \throws InputError unless there are three axes, each size is at least 1 and less than 2^31, and their
///   product is at most `max_voxels`
std::array<int, 3> checked_size(std::span<const std::int64_t> sizes, const std::string& file,
                                std::size_t line, std::int64_t max_voxels = max_volume_voxels);

/// Checks the number of channels.
/// \throws InputError unless it is from 1 to max_channels, 1 for labels, and all values together are at most
///   `max_voxels`
void check_channels(std::int64_t channels, const std::array<int, 3>& size, VoxelUse use,
                    const std::string& file, std::size_t line, std::int64_t max_voxels = max_volume_voxels);

/// Bytes of all voxels of a volume.
std::uint64_t voxel_data_bytes(const std::array<int, 3>& size, VoxelType type, std::int64_t channels = 1);

/// Begin of a message on a body that is too short: "its 2 x 3 x 4 voxels of 2 bytes need 48 bytes, but ".
std::string needed_bytes(const std::array<int, 3>& size, VoxelType type, std::int64_t channels = 1);

// `Value` is MaterialTag for labels, and float for images.

/// Type that a typestr of NumPy names, such as "<u2" or "|b1"; std::nullopt if it is not one of numbers, or
/// has no byte order although it has several bytes.
std::optional<VoxelFormat> format_of_typestr(std::string_view typestr);

/// Converts `n` numbers that are `step` bytes apart.
/// \return the index of the first number that is not a label, or not a value of an image, or `n`
template <class Value>
std::size_t convert_row(const char* from, std::size_t step, std::size_t n, const VoxelFormat& format,
                        Value* to);

/// Message "voxel (1, 2, 3) has the value 0.5, ..." with the reason why the number at `from` is not a label,
/// or not a value of an image.
template <class Value>
std::string bad_voxel(const VoxelName& voxel, const char* from, const VoxelFormat& format);

/// Reads the channels of a body, each with the first axis fastest, converting in parallel. Allocates memory
/// only for voxels that the body can hold, whatever `size` promises.
/// \throws InputError if the body is too short, or at the first voxel that cannot be converted
template <class Value>
std::vector<std::vector<Value>> read_voxels(ByteSource& body, const VoxelFormat& format,
                                            const std::array<int, 3>& size, const ChannelAxis& channels);

/// Reads numbers written as text, separated by white space.
template <class Value>
std::vector<std::vector<Value>> read_voxels_as_text(TextScanner& body, const std::array<int, 3>& size,
                                                    const ChannelAxis& channels);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/io/volumes/voxel_data.h"

namespace tetwright {

/// Axes of an array: indices into its shape.
struct VolumeAxes {
  std::array<std::size_t, 3> spatial{};  ///< x, y and z
  std::optional<std::size_t> channel;    ///< none: there is one channel
};

/// Chooses the three spatial axes of an array of three or more axes, whose last axis is x if it names none,
/// and for images that of channels. Other axes must have one item: a time of several has to be chosen.
/// \param names one for each axis, in lower case; may be empty, and may contain empty names
/// \param file file and array for messages
/// \throws InputError if there are fewer than three, or another axis has several items
VolumeAxes volume_axes(std::span<const std::int64_t> shape, std::span<const std::string> names, VoxelUse use,
                       const std::string& file);

/// Distance in items from one item of an array to the next along each axis.
/// \param order axes, from the one whose items are farthest apart to the one whose items are adjacent
std::vector<std::size_t> strides_of(std::span<const std::int64_t> shape, std::span<const std::size_t> order);

/// Order of the axes of an array whose last axis varies fastest.
std::vector<std::size_t> row_major_order(std::size_t axes);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/io/volumes/data_file.h"
#include "common/io/volumes/encoded_volume.h"
#include "common/io/volumes/raw_volume.h"

namespace tetwright {

/// Opens an array of NumPy (.npy, versions 1 to 3) of three axes, or of four for an image with channels. The
/// axis that varies fastest is x, and that of channels varies slowest: arrays in C order have the axes
/// (channel, z, y, x), those in Fortran order (x, y, z, channel). Axes of one item are left out first. There
/// is no spacing.
///
/// No library is used: the header is one line of Python, and every message names the value.
/// \throws InputError for malformed headers and types other than numbers and booleans
EncodedVolume open_npy(std::string_view bytes, const std::string& name, const FileReader& others,
                       VoxelUse use);

/// RawVolumeFinder of .npy.
std::optional<RawVolume> find_npy(const HeaderBytes& head, const std::string& name, VoxelUse use);

}  // namespace tetwright

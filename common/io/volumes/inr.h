// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/io/volumes/encoded_volume.h"
#include "tetwright/label_volume.h"

namespace tetwright {

/// Opens an INRIMAGE-4 volume, optionally compressed with gzip, as determined by the content, not by the
/// extension. Voxels may be integers or floats of either byte order. Rotated volumes are rejected.
///
/// No library is used: the format is small, and every message names the line and the value.
/// \throws InputError with the line of the header for malformed contents
EncodedVolume open_inr(std::string_view bytes, const std::string& name, const FileReader& others,
                       VoxelUse use);

/// Reads the labels of an INRIMAGE-4 volume.
LabelVolume read_inr(std::string_view bytes, const std::string& name);

}  // namespace tetwright

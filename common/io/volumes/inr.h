// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/label_volume.h"

namespace tetwright {

/// Reads an INRIMAGE-4 volume, compressed with gzip or not; the content decides, not the extension. Voxels
/// may be integers or floats of either byte order. Rotated volumes are rejected.
///
/// Not a library: the format is small, and every message names the line and the value.
/// \param name used in messages
/// \throws InputError with the line of the header for malformed contents
LabelVolume read_inr(std::string_view bytes, const std::string& name);

}  // namespace tetwright

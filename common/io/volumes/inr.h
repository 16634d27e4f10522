// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "tetwright/label_volume.h"

namespace tetwright {

/// Reads an INRIMAGE-4 volume, optionally compressed with gzip, as determined by the content, not by the
/// extension. Voxels may be integers or floats of either byte order. Rotated volumes are rejected.
///
/// No library is used: the format is small, and every message names the line and the value.
/// \param name file name for messages
/// \throws InputError with the line of the header for malformed contents
LabelVolume read_inr(std::string_view bytes, const std::string& name);

}  // namespace tetwright

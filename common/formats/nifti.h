#pragma once

#include <string>
#include <string_view>

#include "common/label_volume.h"

namespace tetwright {

/// NIfTI-1 in one file, gzip-compressed (whatever its name) or not, of either byte order. Coordinates by the
/// sform, else the qform, else the spacing alone. Throws InputError.
LabelVolume read_nifti(std::string_view bytes, const std::string& name);

}  // namespace tetwright

#pragma once

#include <string>
#include <string_view>

#include "common/label_volume.h"

namespace tetwright {

/// INRIMAGE-4, gzip-compressed (whatever its name) or not. Throws InputError.
LabelVolume read_inr(std::string_view bytes, const std::string& name);

}  // namespace tetwright

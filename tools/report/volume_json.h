// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "tetwright/prepare.h"

namespace tetwright {

/// The segmented volume or image in `--stats`: its grid, labels and thresholds.
/// \param colours of labels, red, green and blue
nlohmann::json volume_json(const VolumeReport& volume,
                           const std::map<MaterialTag, std::array<double, 3>>& colours);

}  // namespace tetwright

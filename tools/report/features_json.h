// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "tetwright/mesher.h"

namespace tetwright {

/// `features` of --stats: how the sharp edges of each surface were judged, and what became of each curve.
nlohmann::json features_json(const std::vector<FeatureReport>& all);

}  // namespace tetwright

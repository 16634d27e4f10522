// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "tetwright/prepare.h"

namespace tetwright {

/// Wall time of each stage, seconds.
nlohmann::json seconds_json(const PrepareReport& run);

/// For each stage its parallel loops, and how long it would take on several cores (see LoopTimes).
nlohmann::json loops_json(const PrepareReport& run);

}  // namespace tetwright

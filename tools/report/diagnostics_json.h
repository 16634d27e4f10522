// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "tetwright/diagnostic.h"

namespace tetwright {

/// Coordinates of a point as a list, input units.
nlohmann::json place_json(const Vec3& p);

/// Value of "diagnostics" in --stats and `check --json`: all diagnostics, by their codes.
nlohmann::json diagnostics_json(const std::vector<Diagnostic>& all);

/// Value of "shortfall" in --stats: the requests that were not met.
nlohmann::json shortfall_json(const std::vector<Diagnostic>& all);

}  // namespace tetwright

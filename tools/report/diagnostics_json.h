// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "tetwright/diagnostic.h"

namespace tetwright {

/// A point as its three coordinates, input units.
nlohmann::json place_json(const Vec3& p);

/// "diagnostics" of --stats and of `check --json`: all of them, by their codes.
nlohmann::json diagnostics_json(const std::vector<Diagnostic>& all);

/// "shortfall" of --stats: the requests that were not met.
nlohmann::json shortfall_json(const std::vector<Diagnostic>& all);

}  // namespace tetwright

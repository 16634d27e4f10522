// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "tetwright/value_options.h"
#include "tools/app/commands/command_run.h"

namespace tetwright {

nlohmann::json values_json(const std::vector<ValueReport>& values);
nlohmann::json embedding_json(const EmbeddingReport& embedding);
nlohmann::json bins_json(const std::vector<BinsReport>& divisions);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "tetwright/face_selection.h"
#include "tetwright/parted_interfaces.h"

namespace tetwright {

/// Arrays of the statistics: `selections` and `parted`.
nlohmann::json selections_json(const std::vector<SelectedFaces>& selected);
nlohmann::json parted_json(const std::vector<PartedInterface>& parted);

}  // namespace tetwright

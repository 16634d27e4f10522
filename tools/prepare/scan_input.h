// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>
#include <vector>

#include "mesher/input/label_input.h"
#include "mesher/input/mesher_input.h"
#include "tools/prepare/inputs.h"
#include "tools/prepare/run.h"

namespace tetwright {

/// Scans: surfaces, or one segmented volume.
using ScanInput = std::variant<MesherInput, LabelInput>;

/// Reads the inputs and makes them ready for meshing; reports what was found in them. Throws UsageError for
/// inputs and options that do not go together, and what the readers throw.
ScanInput read_scan(std::vector<Input> inputs, PrepareRun& run);

}  // namespace tetwright

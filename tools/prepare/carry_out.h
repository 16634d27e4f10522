// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/prepare/prepare.h"
#include "tools/prepare/run.h"

namespace tetwright {

/// prepare(), mesh_scans(), simplify_mesh() or improve_mesh() for a caller that reads the report of `run`
/// after an exception, too: it says what was found until then, and stays there. Uses the threads of its
/// caller, see with_threads().
Prepared carry_out(std::vector<Input> inputs, PrepareRun& run);

/// Throws UsageError for options that do not go together, or lack what the task needs.
void check_options(Task task, const PrepareOptions& options);

}  // namespace tetwright

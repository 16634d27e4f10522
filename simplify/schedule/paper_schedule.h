// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/schedule/engine.h"
#include "simplify/schedule/options.h"

namespace tetwright {

/// Runs the schedule of Figure 3 of Cutler, Dorsey & McMillan 2004 (README.md, The paper's schedule).
///
/// \throws Interrupted, OutOfTime.
void run_paper_schedule(Engine& engine, const SimplifyOptions& options);

}  // namespace tetwright

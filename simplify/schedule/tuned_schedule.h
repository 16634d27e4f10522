// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/schedule/engine.h"
#include "simplify/schedule/options.h"

namespace tetwright {

/// The block loop with the tuned schedule (README.md, The tuned schedule), down to the target. The
/// engine is compacted and keeps its input surface. Throws Interrupted and OutOfTime.
void run_tuned_schedule(Engine& engine, const SimplifyOptions& options, std::size_t loop_target);

}  // namespace tetwright

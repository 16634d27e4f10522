// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/schedule/engine.h"
#include "simplify/schedule/options.h"

namespace tetwright {

/// Runs the block loop with the tuned schedule (README.md, The tuned schedule), down to the target.
///
/// \param loop_target 0: as few tets as the tolerance allows.
/// \throws Interrupted, OutOfTime.
/// \pre The engine is compacted and keeps its input surface.
void run_tuned_schedule(Engine& engine, const SimplifyOptions& options, std::size_t loop_target);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/schedule/engine.h"
#include "tetwright/simplify.h"

namespace tetwright {

/// Runs the block iteration with the tuned schedule (README.md, The tuned schedule) down to the target.
///
/// \param loop_target number of tets; 0: as few as the tolerance allows.
/// \throws Interrupted, OutOfTime.
/// \pre The engine is compacted and keeps its input surface.
void run_tuned_schedule(Engine& engine, const SimplifyOptions& options, std::size_t loop_target);

/// Runs collapses alone down to the target, with the bounds on surfaces and volumes that the tuned schedule
/// begins with. Ends early if these or frozen points hold it back.
///
/// \param max_iterations of the block iteration.
/// \throws Interrupted, OutOfTime.
/// \pre The engine is compacted.
void run_light_schedule(Engine& engine, std::size_t target, int max_iterations);

}  // namespace tetwright

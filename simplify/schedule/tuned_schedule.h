// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "simplify/schedule/engine.h"
#include "tetwright/simplify.h"

namespace tetwright {

/// Collapses tets that are far smaller than those that coarsen() leaves: where its parts were cut. Without
/// this the result would have a fifth more tets there if the dense mesh had 300 for each of them.
///
/// \param target number of tets at which to end.
/// \param max_iterations of the block iteration.
/// \throws Interrupted, OutOfTime.
/// \pre The engine is compacted.
void even_out_parts(Engine& engine, std::size_t target, int max_iterations);

/// Runs the block iteration with the tuned schedule (README.md, The tuned schedule) down to the target.
///
/// \param loop_target number of tets; 0: as few as the tolerance allows.
/// \throws Interrupted, OutOfTime.
/// \pre The engine is compacted and keeps its input surface.
void run_tuned_schedule(Engine& engine, const SimplifyOptions& options, std::size_t loop_target);

/// Coarsens the mesh in bulk if it has so many more tets than the target that this pays off.
///
/// \param target number of tets.
/// \pre No operation has run; before compact().
void merge_in_bulk(Engine& engine, double target, std::uint64_t seed);

/// Runs collapses alone, with the bounds on surfaces and volumes that the tuned schedule begins with. Ends
/// early if these or frozen points hold it back.
///
/// \param final_target number of tets that the tuned schedule would aim at; determines the annealing.
/// \param loop_target number of tets at which to end.
/// \param max_iterations of the block iteration.
/// \throws Interrupted, OutOfTime.
/// \pre The engine is compacted.
void run_collapses(Engine& engine, double final_target, std::size_t loop_target, int max_iterations);

}  // namespace tetwright

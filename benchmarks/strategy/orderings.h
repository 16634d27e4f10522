// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "benchmarks/strategy/workpiece.h"

namespace tetwright {

/// A progressive mesh (Hoppe 1996): collapses the half-edge of least Weight in a priority queue of all of
/// them, then weighs and queues again those whose weight may have changed, which begin at a link point of the
/// removed point. Half-edges that only end there keep their weight, since it and the tets they deform depend
/// on the star of their origin alone; their legality is tested when they come up. Ends at the target, or when
/// the queue is empty.
///
/// Outdated entries stay in the queue until they come up, which takes less time than finding them.
///
/// \param eager tests the legality of each half-edge whenever it is weighed, as the paper says of progressive
///   meshes, and queues only legal ones; otherwise only those that come up are tested.
void progressive_mesh(Workpiece& piece, bool eager);

/// Figure 3 of the paper restricted to collapses: weighs the twelve half-edges of each tet of the block and
/// tries those below E in ascending order. E begins at the ideal edge and follows the paper's schedule.
void block_of_tets(Workpiece& piece, std::uint64_t seed);

/// The default schedule of simplify() restricted to collapses: the points of the block's tets, each once,
/// with its four best half-edges below E.
void block_of_points(Workpiece& piece, std::uint64_t seed);

}  // namespace tetwright

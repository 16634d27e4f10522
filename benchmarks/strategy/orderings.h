// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "benchmarks/strategy/workpiece.h"

namespace tetwright {

/// Simplifies as a progressive mesh (Hoppe 1996): collapses the half-edge with the smallest Weight from a
/// priority queue of all half-edges, then recomputes and queues those whose weight may have changed, which
/// begin at a link point of the removed point. Half-edges that only end there keep their weight, since it and
/// the tets they deform depend only on the star of their origin; their legality is tested when they reach the
/// top of the queue. Ends at the target, or when the queue is empty.
///
/// Outdated entries stay in the queue until they reach its top, which takes less time than finding them.
///
/// \param eager true: test the legality of each half-edge whenever its weight is computed, as the paper
///   describes progressive meshes, and queue only legal ones; false: test only those that reach the top
void progressive_mesh(Workpiece& piece, bool eager);

/// Figure 3 of the paper restricted to collapses: computes the weights of the twelve half-edges of each tet
/// of the block and tries those below E in ascending order. E starts at the ideal edge and follows the
/// paper's schedule.
void block_of_tets(Workpiece& piece, std::uint64_t seed);

/// The default schedule of simplify() restricted to collapses: each point of the block's tets once, with its
/// four best half-edges below E.
void block_of_points(Workpiece& piece, std::uint64_t seed);

}  // namespace tetwright

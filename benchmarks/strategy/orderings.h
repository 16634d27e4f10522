// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "benchmarks/strategy/workpiece.h"

namespace tetwright {

/// A progressive mesh (Hoppe 1996): one priority queue of all half-edges by Weight, the least is collapsed,
/// then all whose weight that may have changed are weighed and queued anew: those that begin at a point of
/// the vanished point's link. Half-edges that only end there keep their weight, since it and the tets they
/// deform depend on the star of their beginning alone; whether they are legal is tested when they come up.
///
/// Outdated entries stay in the queue until they come up, which takes less time than finding them. `eager`:
/// the legality of each half-edge is tested whenever it is weighed, as the paper says of progressive meshes,
/// and only legal ones are queued; else only of those that come up. Ends at the target, or when the queue is
/// empty.
void progressive_mesh(Workpiece& piece, bool eager);

/// Figure 3 of the paper restricted to collapses: of each tet of the block its twelve half-edges are weighed
/// and tried, those below E, in ascending order. E begins at the ideal edge and follows the paper's schedule.
void block_of_tets(Workpiece& piece, std::uint64_t seed);

/// What simplify() does by default, restricted to collapses: the points of the block's tets, each once, and
/// its four best half-edges below E.
void block_of_points(Workpiece& piece, std::uint64_t seed);

}  // namespace tetwright

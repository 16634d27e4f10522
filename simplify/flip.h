#pragma once

#include "simplify/task.h"

namespace tetwright {

/// Flips inside one material (Freitag & Ollivier-Gooch 1997). Both take a tet whose four points the task
/// holds; more points are locked as they are needed and stay in `task.points`. done: the mesh was changed,
/// the poorest of the new tets is better than the poorest of the old ones. Otherwise nothing was changed.

/// Flip 2-3 across a face: the tet and its neighbour become three around a new edge, which must not exist
/// yet.
Outcome flip23(Task& task, const BlockRules& rules, Index tet, int face);

/// Flip 3-2 of an edge: the three tets around it become two that share a new face.
/// `edge` counts in tet_edges.
Outcome flip32(Task& task, const BlockRules& rules, Index tet, int edge);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/flip_reach.h"
#include "simplify/operations/workspace.h"

namespace tetwright {

/// Multi-face removal, the inverse of edge removal: removes a face within one material, together with
/// neighbouring faces that lie between the same two apices, and creates tets around the edge between these
/// apices (Shewchuk 2002, as in remove_edge(); the faces are chosen by his recursion over the tree of
/// neighbouring faces). A single face makes the flip 2-3.
///
/// Counts itself as flip23 or face_removal.
///
/// \param face slot of the opposite vertex in `tet`.
/// \return done (proposed), no_candidate (boundary), material_rule, quality (also: would invert),
///   link_condition (the edge exists already) or count.
Outcome remove_face(Workspace& ws, const BlockRules& rules, Index tet, int face, const FlipReach& reach);

}  // namespace tetwright

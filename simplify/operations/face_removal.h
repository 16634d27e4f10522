// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/flip_reach.h"
#include "simplify/operations/workspace.h"

namespace tetwright {

/// Takes out a face within one material, and with it such neighbouring faces that stand between the same two
/// points, and puts tets around the edge between these points: multi-face removal, the inverse of edge
/// removal (Shewchuk 2002, as in remove_edge; the faces are chosen by his recursion over the tree of
/// neighbouring faces). One face makes the flip 2-3. `face` is opposite the tet's vertex of
/// that number.
///
/// Counts itself as flip23 or face_removal. Answers done (proposed), no_candidate (boundary), material_rule,
/// quality (also: would invert), link_condition (the edge is there already), count.
Outcome remove_face(Workspace& ws, const BlockRules& rules, Index tet, int face, const FlipReach& reach);

}  // namespace tetwright

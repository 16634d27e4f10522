// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/flip_reach.h"
#include "simplify/operations/workspace.h"

namespace tetwright {

/// Takes an edge (`edge` of tet_edges of a tet) out and fills the place of the tets
/// around it anew, where the worst becomes better: edge removal (Shewchuk 2002, "Two discrete optimization
/// algorithms for the topological improvement of tetrahedral meshes"; the triangulation of the ring by the
/// dynamic program of Klincsek). Within one material the ring is one polygon, three points make the flip 3-2.
/// An edge of the boundary has an open chain of points: two tets make the flip 2-2. An edge of an interface
/// between two regions has two chains that share their ends: two tets on each side make the flip 4-4; both
/// new interface triangles have the edge between the ends. Edges of junction curves stay.
///
/// Counts itself as flip32, flip22, flip44 or edge_removal. Answers done (proposed), no_candidate,
/// material_rule, too_large, quality (also: would invert), link_condition (the new edge is there already),
/// surface_error (Error(op) above E), self_intersection, volume, count.
Outcome remove_edge(Workspace& ws, const BlockRules& rules, Index tet, int edge, const FlipReach& reach);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/flip_reach.h"
#include "simplify/operations/workspace.h"

namespace tetwright {

/// Edge removal: replaces the tets around an edge by tets without it if that improves the worst one (Shewchuk
/// 2002, "Two discrete optimization algorithms for the topological improvement of tetrahedral meshes"; the
/// ring is triangulated by Klincsek's dynamic program).
///
/// - Within a material the ring is one polygon; three points make the flip 3-2.
/// - A boundary edge has an open chain of points; two tets make the flip 2-2.
/// - An edge of an interface between two regions has two chains that share their ends; two tets on each side
///   make the flip 4-4. The two new interface triangles share the edge between these ends.
/// - Edges of junction curves are never removed.
///
/// Counts itself as flip32, flip22, flip44 or edge_removal.
///
/// \param edge index into tet_edges of `tet`.
/// \return done (proposed), no_candidate, material_rule, too_large, quality (also: would invert),
///   link_condition (the new edge exists already), surface_error (Error(op) above E), self_intersection,
///   volume or count.
Outcome remove_edge(Workspace& ws, const BlockRules& rules, Index tet, int edge, const FlipReach& reach);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/workspace.h"

namespace tetwright {

/// How an inserted point finds its place.
enum class InsertionPlace {
  centre,  ///< as in section 4 of the paper: the centre of the tet, face or edge
  /// From there where find_place() leads; tets around that the new point sees well go too, so that one tet
  /// need not become four of its shape.
  best
};

/// Adds a point in a tet, at its centre: one tet becomes four. What comes out decides:
/// the worst new tet must be better than the old one (or pass the annealing). Counted as insert_in_tet.
///
/// These three answer done (proposed), no_candidate, too_large, material_rule, quality (also: would invert),
/// surface_error, link_condition, self_intersection, volume, count.
Outcome insert_in_tet(Workspace& ws, const BlockRules& rules, Index tet, InsertionPlace place);

/// Adds a point in a face of the boundary or of an interface, whose one or two tets become three each.
/// Counted as insert_in_face.
Outcome insert_in_face(Workspace& ws, const BlockRules& rules, Index tet, int face, InsertionPlace place);

/// Adds a point in an edge (of tet_edges), which halves all tets around it: edges of the boundary, of
/// interfaces and junction curves, and with `interior` all. Counted as insert_in_edge.
Outcome insert_in_edge(Workspace& ws, const BlockRules& rules, Index tet, int edge, InsertionPlace place,
                       bool interior);

}  // namespace tetwright

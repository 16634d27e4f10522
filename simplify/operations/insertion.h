// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/workspace.h"

namespace tetwright {

/// Position of an inserted point.
enum class InsertionPlace {
  centre,  ///< the centroid of the tet, face or edge, as in section 4 of the paper
  /// The best position that find_position() reaches from the centroid. Surrounding tets that are well visible
  /// from the new point are removed as well, so that a tet need not become four tets of similar shape.
  best
};

/// Inserts a point in a tet, which becomes four. Accepted only if the worst new tet is better than the worst
/// old one, or annealing accepts it. Counted as insert_in_tet.
///
/// \return for all three insertions: done (proposed), no_candidate, too_large, material_rule, quality (also:
///   would invert), surface_error, link_condition, self_intersection, volume or count.
Outcome insert_in_tet(Workspace& ws, const BlockRules& rules, Index tet, InsertionPlace place);

/// Inserts a point in a boundary or interface face, whose one or two tets become three each. Counted as
/// insert_in_face.
Outcome insert_in_face(Workspace& ws, const BlockRules& rules, Index tet, int face, InsertionPlace place);

/// Inserts a point in an edge, which halves all tets around it. Counted as insert_in_edge.
///
/// \param edge index into tet_edges of `tet`.
/// \param interior also accepts edges within a material, not only edges of the boundary, of interfaces and of
///   junction curves.
Outcome insert_in_edge(Workspace& ws, const BlockRules& rules, Index tet, int edge, InsertionPlace place,
                       bool interior);

}  // namespace tetwright

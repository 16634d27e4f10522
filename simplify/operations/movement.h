// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simplify/operations/workspace.h"

namespace tetwright {

// Steps that all moves of a star's centre share, whichever search chose the position.

/// The length of the shortest edge at the centre.
double shortest_edge(const Star& star);

/// Whether all interface triangles at the centre are in one plane.
/// \pre Gradients are computed.
bool is_flat(const Star& star);
/// Whether the centre lies within a patch that is flat in the given surface, even if its neighbours do not
/// all lie in that plane.
bool is_in_flat_patch(const Star& star, const BlockRules& rules);

/// Rates a move of the centre to `to` by Error(op) and quality.
///
/// \param limit quality that every tet must exceed.
/// \param qualities gets the qualities of the star's tets, in their order; sized by the caller.
/// \param worst gets the lowest of them.
/// \return done, surface_error or quality.
Outcome rate(Star& star, const BlockRules& rules, const Vec3& to, float limit, std::vector<float>& qualities,
             float& worst);

/// Proposes the move if surface, feature edges and bounds allow it.
///
/// \param qualities of the star's tets at `to`.
Outcome move_to(Workspace& ws, const BlockRules& rules, const Vec3& to, const std::vector<float>& qualities);

}  // namespace tetwright

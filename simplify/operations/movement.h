// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simplify/operations/workspace.h"

namespace tetwright {

// What moves of a star's centre share, whoever has chosen the place.

/// The length of the shortest edge at the centre.
double shortest_edge(const Star& star);

/// Whether all interface triangles at the centre are in one plane. Gradients must be computed.
bool is_flat(const Star& star);

/// Whether the centre may stand at `to`: fills `qualities` and answers done, or why not. `limit` is what the
/// worst tet must exceed.
Outcome rate(Star& star, const BlockRules& rules, const Vec3& to, float limit, std::vector<float>& qualities,
             float& worst);

/// Proposes the move where the surface allows it; `qualities` are those at `to`.
Outcome move_to(Workspace& ws, const BlockRules& rules, const Vec3& to, const std::vector<float>& qualities);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/workspace.h"

namespace tetwright {

/// Half-edge collapse: the star's centre is drawn onto one of its link points, its edge's tets vanish.
///
/// Of the allowed targets (the edge has the dimension of the centre: an interior point goes anywhere, a point
/// of an interface stays on it, one of a junction curve too; spanning edges never collapse) the
/// BlockRules::max_targets of least Weight = length + Error (Cutler, Dorsey & McMillan 2004, section 4) are
/// tried and the first that passes every test is proposed. Tests come in the order of their cost: E,
/// signs, quality, link condition, self-intersection.
///
/// Of the star that `ws.gather()` left in `ws.star`. done: `ws.proposal` says what is to be done. Otherwise
/// the outcome is that of the target that got farthest.
Outcome collapse(Workspace& ws, const BlockRules& rules);

/// The same for one target alone, the link point with local number b.
Outcome collapse_onto(Workspace& ws, const BlockRules& rules, std::size_t b);

/// Weight(e) of the half-edge from the centre to link point b: length plus Error(collapse). The star's
/// gradients must be computed.
double collapse_weight(Star& star, std::size_t b, const BlockRules& rules);

}  // namespace tetwright

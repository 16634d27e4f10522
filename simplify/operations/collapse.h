// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/workspace.h"

namespace tetwright {

/// Half-edge collapse: moves the centre of the gathered star (Workspace::gather()) onto one of its link
/// points; the tets at the edge vanish.
///
/// The edge must have the dimension given by collapse_table. Tries the CollapseLimits::max_targets targets of
/// least Weight = length + Error (Cutler, Dorsey & McMillan 2004, section 4) and proposes the first that
/// passes every test. Tests run in order of cost: E, signs, quality, link condition, self-intersection.
///
/// \return done: `ws.proposal` is complete. Otherwise the outcome of the target that passed the most tests.
Outcome collapse(Workspace& ws, const BlockRules& rules);

/// Tries a single target.
///
/// \param b local number of the target among the link points.
Outcome collapse_onto(Workspace& ws, const BlockRules& rules, std::size_t b);

/// Weight(e) of the half-edge from the centre to link point b: length plus Error(collapse).
/// \pre star.compute_gradients() has been called.
double collapse_weight(Star& star, std::size_t b, const BlockRules& rules);

}  // namespace tetwright

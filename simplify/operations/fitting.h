// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/workspace.h"

namespace tetwright {

/// Moves the centre of the gathered star, if it lies on an interface, so that the planes of its triangles fit
/// their samples (SurfaceGrid::samples()) in the least-squares sense, by the whole, half or quarter step.
/// Edges so come to lie on ridges of the input. With BlockRules::fit_farthest the farthest samples count
/// most. Points of flat patches stay.
///
/// \param floor the worst tet must stay above it or hardly get worse.
/// \return as smooth(); no_candidate for other points, without samples, and if the step would be too short.
Outcome fit_to_samples(Workspace& ws, const BlockRules& rules, float floor);

/// Moves the centre of the gathered star, if it lies where patches meet, onto its feature edge or corner,
/// unless it is there already. Position has priority over shape.
///
/// \param floor the worst tet must stay above it or hardly get worse.
/// \return as smooth(); no_candidate for other points.
Outcome fit_to_crease(Workspace& ws, const BlockRules& rules, float floor);

}  // namespace tetwright

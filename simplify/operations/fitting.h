// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/operations/workspace.h"

namespace tetwright {

/// Moves the centre of the gathered star, if it lies on an interface, to where the distances of the samples
/// that its triangles own (SurfaceGrid::samples()) from their planes are smallest in the least-squares sense,
/// whole, half or quarter way: along ridges of the input its edges come to lie on them. With
/// BlockRules::fit_farthest the farthest count most. Points of flat patches stay. The worst tet must stay
/// above `floor` or hardly get worse. Answers as smooth(); no_candidate for other points, without samples,
/// and where the step would be short.
Outcome fit_to_samples(Workspace& ws, const BlockRules& rules, float floor);

/// Moves the centre of the gathered star, if it lies where patches meet, to the crease or the corner that it
/// stands for, unless it is there: places come before shapes, as long as the worst tet stays above `floor` or
/// hardly gets worse. Same answers; no_candidate for other points.
Outcome fit_to_crease(Workspace& ws, const BlockRules& rules, float floor);

}  // namespace tetwright

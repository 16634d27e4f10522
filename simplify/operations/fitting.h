// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "simplify/operations/workspace.h"

namespace tetwright {

/// Weights of samples in a fit.
enum class SampleWeights : std::uint8_t {
  equal,
  squared_distance  ///< the farthest samples count most
};

/// Moves the centre of the gathered star, if it lies on an interface, so that the planes of its triangles fit
/// their samples (SurfaceGrid::samples()) in the least-squares sense. Tries the whole, half and quarter step.
/// As a result, edges align with ridges of the input. Points of flat patches do not move.
///
/// \param floor the worst tet must stay above it or hardly get worse.
/// \return as smooth(); no_candidate for other points, without samples, or if the step would be too short.
Outcome fit_to_samples(Workspace& ws, const BlockRules& rules, float floor,
                       SampleWeights weights = SampleWeights::equal);

/// Moves the centre of the gathered star, if it lies where patches meet, onto its feature edge or corner,
/// unless it is there already. Position has priority over shape.
///
/// \param floor the worst tet must stay above it or hardly get worse.
/// \return as smooth(); no_candidate for other points.
Outcome fit_to_crease(Workspace& ws, const BlockRules& rules, float floor);

}  // namespace tetwright

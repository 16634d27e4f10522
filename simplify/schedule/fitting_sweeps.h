// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simplify/schedule/engine.h"

namespace tetwright {

// Sweeps that move points of the surface nearer to the input's. The worst tet at a moved point must stay
// above the quality `floor`, or hardly get worse.

/// fit_to_samples() for the points of boundary and interfaces.
///
/// \param above only those of regions with a larger VolumeLedger::utilization().
void fit_interfaces(Engine& engine, float floor, double above = -1);
/// fit_to_samples() for the points of and around the listed tets, weighting the farthest samples most.
void fit_farthest_samples(Engine& engine, const std::vector<TetSnapshot>& tets, float floor);
/// fit_to_crease() for all boundary points off their feature edge or corner. A point that cannot be moved
/// onto it is collapsed along its feature edge.
void fit_feature_edges(Engine& engine);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "tetwright/mesher.h"
#include "tetwright/prepare.h"

namespace tetwright {

/// Dense tets that thin walls and gaps may add for each of the result, and their max number. A gap of
/// .01 between boxes of size 1 stays open at 10,000 tets with some 3.5 million.
inline constexpr double thin_tets_share = 400, max_thin_tets = 8e6;
/// Below this target the number falls with the target to the power of 1.5: few tets hardly have room for thin
/// walls and gaps. At 300 tets a scan then takes about three times as long as the bunny.
inline constexpr double full_thin_target = 5000;

/// Dense tets that thin walls and gaps may add for a target.
inline double thin_tets_of_target(double tets) {
  return std::min(thin_tets_share * tets * std::sqrt(std::min(1.0, tets / full_thin_target)), max_thin_tets);
}

/// The request that would open the gaps that cells closed, by their width and area: the smallest larger
/// --target-tets whose cells are small enough and within the bounds above, or else the --max-refinement that
/// the present cells need. Nothing if no gap was closed, or no such cells are allowed. Takes as long as
/// choosing cells a few times.
GapOpening find_gap_opening(const MesherInput& surfaces, const MesherReport& report,
                            const PrepareOptions& options);

}  // namespace tetwright

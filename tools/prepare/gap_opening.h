// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/mesher.h"
#include "tetwright/prepare.h"

namespace tetwright {

/// Dense tets that thin walls and gaps may add for each of the result, and bounds of their number. A gap of
/// .01 between boxes of size 1 stays open at 10,000 tets with some 3.5 million.
inline constexpr double thin_tets_share = 400, min_thin_tets = 2e6, max_thin_tets = 8e6;

/// The request that would open the gaps that cells closed, by their width and area: the smallest larger
/// --target-tets whose cells are small enough and within the bounds above, or else the --max-refinement that
/// the present cells need. Nothing if no gap was closed, or no such cells are allowed. Takes as long as
/// choosing cells a few times.
GapOpening find_gap_opening(const MesherInput& surfaces, const MesherReport& report,
                            const PrepareOptions& options);

}  // namespace tetwright

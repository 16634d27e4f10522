// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "tetwright/mesher.h"
#include "tetwright/prepare.h"

namespace tetwright {

/// Dense tets that thin walls and gaps may add for each of the result, and the max of their number. A gap of
/// .01 between boxes of size 1 stays open at 10,000 tets with some 3.5 million.
inline constexpr double thin_tets_share = 400, max_thin_tets = 8e6;
/// Some thousand tets open gaps with that many more. Fewer tets can hardly have thin walls and gaps, which
/// then need not cost many times what the rest does.
inline constexpr double small_target_share = 1000, small_target_tets = 2e6, min_thin_tets = 3e5;

/// Dense tets that thin walls and gaps may add for a target.
inline double thin_tets_of_target(double tets) {
  const double low = std::clamp(small_target_share * tets, min_thin_tets, small_target_tets);
  return std::clamp(thin_tets_share * tets, low, max_thin_tets);
}

/// The request that would open the gaps that cells closed, by their width and area: the smallest larger
/// --target-tets whose cells are small enough and within the bounds above, or else the --max-refinement that
/// the present cells need. Nothing if no gap was closed, or no such cells are allowed. Takes as long as
/// choosing cells a few times.
GapOpening find_gap_opening(const MesherInput& surfaces, const MesherReport& report,
                            const PrepareOptions& options);

}  // namespace tetwright

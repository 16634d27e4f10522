// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "mesher/domain/refinement_regions.h"
#include "mesher/thin/local_thickness.h"

namespace tetwright {

/// If cells of a region are split for other reasons, gives the whole region cells of that size. Applies to
/// small regions too.
void follow_cells(LocalThickness& measured, const RefinementRegions& finer);

/// Limits of the refinement of thin walls.
struct RefinementBudget {
  int max_depth = default_wall_refinement;
  int max_possible = max_wall_refinement;  ///< allowed by the lattice
  /// Exceed max_depth, up to max_wall_refinement, in regions where that adds at most `base_tets`.
  bool deeper_where_cheap = true;
  double base_tets = 0;  ///< dense tets without refinement
  double max_tets = 0;   ///< limit for all regions together
};

/// Chooses the depth of each region as a whole, the cheapest regions first, within the budget. Where only
/// gaps are thin, a depth must open a part of what the one before leaves closed.
void choose_depths(const std::vector<LocalThickness*>& all_measured, const RefinementBudget& budget);

}  // namespace tetwright

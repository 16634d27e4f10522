// SPDX-License-Identifier: Apache-2.0
#include "mesher/thin/refinement_depths.h"

#include <algorithm>

#include "mesher/tuning/distance_tuning.h"

namespace tetwright {

void follow_cells(LocalThickness& measured, const RefinementRegions& finer) {
  for (int depth = 0; depth < finer.refinement; ++depth)
    for (const MortonKey cell : finer.cells[static_cast<std::size_t>(finer.refinement - depth)]) {
      const MortonKey voxel = cell >> (3 * depth);
      const auto at = std::lower_bound(measured.voxels.begin(), measured.voxels.end(), voxel);
      if (at == measured.voxels.end() || *at != voxel) continue;
      LocalThickness::Region& region =
          measured.regions[measured.region[static_cast<std::size_t>(at - measured.voxels.begin())]];
      region.asked = std::max(region.asked, depth + 1);
    }
}

void choose_depths(const std::vector<LocalThickness*>& all_measured, const RefinementBudget& budget) {
  std::vector<LocalThickness::Region*> regions;
  for (LocalThickness* measured : all_measured)
    for (LocalThickness::Region& region : measured->regions) regions.push_back(&region);
  // Tets that a region adds at a depth.
  const auto added = [](const LocalThickness::Region& r, int depth) { return r.tets[depth] - r.tets[0]; };
  for (LocalThickness::Region* r : regions) {
    const int needed = std::min(r->needed, budget.max_possible);
    r->depth = std::max(std::min(needed, budget.max_depth), std::min(r->asked, budget.max_possible));
    if (budget.deeper_where_cheap)
      while (r->depth < needed && added(*r, r->depth + 1) <= budget.base_tets) ++r->depth;
  }
  std::stable_sort(regions.begin(), regions.end(),
                   [&](const auto* a, const auto* b) { return added(*a, a->depth) < added(*b, b->depth); });
  double left = budget.max_tets;
  for (LocalThickness::Region* r : regions) {
    while (r->depth > 0 && added(*r, r->depth) > left) --r->depth;
    const auto opens_more = [&](int depth) {
      return r->has_walls ||
             r->closed[depth] <= DistanceTuning::WallCells::max_left_closed * r->closed[depth - 1];
    };
    while (r->depth > std::min(r->asked, budget.max_possible) && !opens_more(r->depth)) --r->depth;
    left -= added(*r, r->depth);
  }
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/improve_area.h"

#include <algorithm>

#include "simplify/schedule/bulk_improvement.h"

namespace tetwright {

namespace {

/// Max rounds of each bulk phase.
constexpr int max_bulk_rounds = 30;
/// Share of the tets still below the bound above which the second bulk phase runs.
constexpr double bulk_after = 0.01;
/// Factor between successive bounds.
constexpr double bound_step = 1.18;

}  // namespace

int improve_area(const ImprovementTools& tools, ImprovementArea& area, ImprovementPlan plan,
                 double bulk_first) {
  const auto bad_quality = static_cast<float>(shape_quality_bound(tools.rules.objective.shape, plan.angle));
  const int rounds = plan.max_rounds;
  for (const double bulk_above : {bulk_first, bulk_after}) {
    const bool second = bulk_above == bulk_after;
    if (plan.max_rounds <= 0 || (second && plan.brief)) break;
    const bool bulk = static_cast<double>(area.bad_tets(bad_quality).size()) >
                      bulk_above * static_cast<double>(area.tet_count());
    if (second && !bulk) break;
    if (bulk)
      plan.max_rounds -= run_bulk_improvement(tools, area,
                                              {.kind = plan.kind,
                                               .bad_quality = bad_quality,
                                               .min_tets = plan.min_tets,
                                               .max_tets = plan.max_tets,
                                               .max_rounds = std::min(plan.max_rounds, max_bulk_rounds),
                                               .remodel = true});
    plan.max_rounds -= run_improvement(tools, area, plan);
  }
  return rounds - plan.max_rounds;
}

std::vector<double> rising_bounds(double first, double last) {
  std::vector<double> bounds;
  for (double bound = first; bound < last; bound *= bound_step) bounds.push_back(bound);
  bounds.push_back(last);
  return bounds;
}

}  // namespace tetwright

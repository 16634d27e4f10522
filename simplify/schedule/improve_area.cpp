// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/improve_area.h"

#include <algorithm>

#include "simplify/schedule/bulk_improvement.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using BulkRounds = SimplifyTuning::BulkRounds;
using Improve = SimplifyTuning::Improve;

}  // namespace

int improve_area(const ImprovementTools& tools, ImprovementArea& area, ImprovementPlan plan,
                 double bulk_first) {
  const auto bad_quality = static_cast<float>(shape_quality_bound(tools.rules.objective.shape, plan.angle));
  const int rounds = plan.max_rounds;
  for (const double bulk_above : {bulk_first, BulkRounds::again_above}) {
    const bool second = bulk_above == BulkRounds::again_above;
    if (plan.max_rounds <= 0 || (second && plan.brief)) break;
    const bool bulk = static_cast<double>(area.bad_tets(bad_quality).size()) >
                      bulk_above * static_cast<double>(area.tet_count());
    if (second && !bulk) break;
    if (bulk)
      plan.max_rounds -=
          run_bulk_improvement(tools, area,
                               {.kind = plan.kind,
                                .bad_quality = bad_quality,
                                .min_tets = plan.min_tets,
                                .max_tets = plan.max_tets,
                                .max_rounds = std::min(plan.max_rounds, BulkRounds::max_rounds),
                                .remodel = true});
    plan.max_rounds -= run_improvement(tools, area, plan);
  }
  return rounds - plan.max_rounds;
}

std::vector<double> rising_bounds(double first, double last) {
  std::vector<double> bounds;
  for (double bound = first; bound < last; bound *= Improve::bound_step) bounds.push_back(bound);
  bounds.push_back(last);
  return bounds;
}

}  // namespace tetwright

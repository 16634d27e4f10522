// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simplify/schedule/improvement.h"

namespace tetwright {

/// Improves the tets below plan.angle: first in bulk if more than `bulk_first` of the area's tets are below
/// it, then the worst first. If more than next to nothing is still below it, bulk and worst first are
/// repeated once, unless the plan is brief.
///
/// \return number of rounds.
/// \throws Interrupted, OutOfTime.
int improve_area(const ImprovementTools& tools, ImprovementArea& area, ImprovementPlan plan,
                 double bulk_first);

/// Ascending bounds (steradians) from `first` to `last`, `last` included. The worst tets so come first also
/// on a large scale: a bound that most tets are below would leave no time for them.
std::vector<double> rising_bounds(double first, double last);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simplify/schedule/improvement.h"

namespace tetwright {

/// Improves the tets below plan.angle: first in bulk if more than the fraction `bulk_first` of the area's
/// tets are below it, then worst first. If a significant fraction remains below it, repeats both once, unless
/// the plan is brief.
///
/// \return number of rounds.
/// \throws Interrupted, OutOfTime.
int improve_area(const ImprovementTools& tools, ImprovementArea& area, ImprovementPlan plan,
                 double bulk_first);

/// Ascending bounds (steradians) from `first` to `last`, inclusive. With rising bounds the worst tets are
/// improved first; a bound that most tets are below would leave no time for them.
std::vector<double> rising_bounds(double first, double last);

}  // namespace tetwright

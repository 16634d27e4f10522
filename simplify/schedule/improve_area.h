// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simplify/schedule/improvement.h"

namespace tetwright {

/// Improves what is below plan.angle: in bulk first where more than `bulk_first` of the area's tets are below
/// it, then the worst first; what still is below it after that is taken up in bulk again and once more,
/// unless it is next to nothing or the plan is brief. Returns the number of rounds it took. Throws
/// Interrupted.
int improve_area(const ImprovementTools& tools, ImprovementArea& area, ImprovementPlan plan,
                 double bulk_first);

/// The bounds (steradians) on the way to `last`, ascending, `last` being the last one: the worst first, also
/// in the large, since a bound that most tets are below would leave no time for them.
std::vector<double> rising_bounds(double first, double last);

}  // namespace tetwright

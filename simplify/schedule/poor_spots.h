#pragma once

#include "simplify/schedule/improvement.h"

namespace tetwright {

/// Where tets stay below `angle` (steradians), edges around them are halved, and what comes out is improved
/// by `plan` as the rest was: smaller tets have more ways to be well shaped. Again until none is left or
/// that gains nothing, while the plan has rounds.
///
/// The mesh is compacted and rated by shape. Throws Interrupted.
void refine_poor_spots(const ImprovementTools& tools, ImprovementArea& area, ImprovementPlan plan,
                       double angle);

}  // namespace tetwright

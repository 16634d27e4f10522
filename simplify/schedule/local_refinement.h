// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/schedule/engine.h"
#include "simplify/schedule/improvement.h"

namespace tetwright {

/// Where tets stay below `angle` (steradians), edges around them are halved, and what comes out is improved
/// by `plan` as the rest was: smaller tets have more ways to be well shaped. Again until none is left or
/// that gains nothing, while the plan has rounds.
///
/// The mesh is compacted and rated by shape. Throws Interrupted and OutOfTime.
void refine_bad_tets(const ImprovementTools& tools, ImprovementArea& area, ImprovementPlan plan,
                     double angle);

/// Where the mesh's surface is farther than `limit` (working coordinates) from the input's, on either side,
/// edges of its faces are halved, what comes out is improved by `plan` and fitted: samples bound the distance
/// at samples only, and on smaller faces these are closer together. Again until no face is that far,
/// a few times. Nothing where more than a few faces are: then samples are not the reason.
///
/// The engine's input surface is kept and measured, its triangles own samples; else as refine_bad_tets().
void refine_beyond_tolerance(Engine& engine, ImprovementArea& area, const ImprovementPlan& plan, double angle,
                             double limit);

}  // namespace tetwright

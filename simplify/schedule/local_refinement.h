// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/schedule/engine.h"
#include "simplify/schedule/improvement.h"

namespace tetwright {

/// Halves edges around tets that stay below `angle` (steradians) and improves the result by `plan`: smaller
/// tets have more ways to be well shaped. Repeats until no such tet is left or that gains nothing, while the
/// plan has rounds.
///
/// \throws Interrupted, OutOfTime.
/// \pre The mesh is compacted and rated by shape.
void refine_bad_tets(const ImprovementTools& tools, ImprovementArea& area, ImprovementPlan plan,
                     double angle);

/// Halves edges of faces that are farther than `limit` (working coordinates) from the input's surface, on
/// either side, improves the result by `plan` and fits it: samples bound the distance only at samples, which
/// are closer together on smaller faces. Repeats a few times, until no face is that far. Does nothing if more
/// than a few faces are: then samples are not the reason.
///
/// \throws Interrupted, OutOfTime.
/// \pre As for refine_bad_tets(); the engine keeps and measures its input surface, and its triangles own
///   samples.
void refine_beyond_tolerance(Engine& engine, ImprovementArea& area, const ImprovementPlan& plan, double angle,
                             double limit);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/schedule/engine.h"
#include "simplify/schedule/improvement.h"

namespace tetwright {

/// Halves edges around tets that stay below `angle` (steradians) and improves the result by `plan`, since
/// smaller tets can be well shaped more easily. Repeats until no such tet is left, there is no more gain, or
/// the plan's rounds are used up.
///
/// \throws Interrupted, OutOfTime.
/// \pre The mesh is compacted and rated by shape.
void refine_bad_tets(const ImprovementTools& tools, ImprovementArea& area, ImprovementPlan plan,
                     double angle);

/// Halves edges of faces whose two-sided distance from the input's surface exceeds `limit` (working
/// coordinates), improves the result by `plan` and fits it. Samples bound the distance only at their
/// positions, which are closer together on smaller faces. Repeats a few times until no face is that far. Does
/// nothing if more than a few faces are, since then sampling is not the cause.
///
/// \throws Interrupted, OutOfTime.
/// \pre As for refine_bad_tets(); the engine's InputSamples keep a measured surface and are assigned.
void refine_beyond_tolerance(Engine& engine, ImprovementArea& area, const ImprovementPlan& plan, double angle,
                             double limit);

}  // namespace tetwright

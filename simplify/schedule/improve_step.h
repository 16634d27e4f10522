// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/schedule/block_runner.h"

namespace tetwright {

/// Qualities (shape_quality()) below which a tet is worked on, and points may leave the surface for it.
struct ImproveBounds {
  float bad_quality, leave_surface;
};

/// The rules of an improvement step.
struct ImproveRules {
  const BlockRules& rules;
  const BlockRules& relaxed;  ///< of edge removals and collapses: relaxed_rules()
  ImproveBounds bounds;
  bool last_resort;  ///< points of tets worse than bounds.leave_surface move by `relaxed`, too
  bool flips_first;  ///< before better places: half the time, but less gain in thin layers of many materials
};

/// One improvement step at a tet: tries actions until one makes the worst tet around better.
Outcome improve_tet(Workspace& ws, const ImproveRules& step, const TetSnapshot& item);

/// A flip of the tet, chosen at random, that leaves only good tets (BlockRules::good_enough) or an
/// improvement: it changes the connectivity near tets that no operation improves.
Outcome perturb_tet(Workspace& ws, const BlockRules& perturbation, const TetSnapshot& item);

/// Rules of collapses that cut off an ear and of edge removal. They sweep much volume though the surface
/// hardly moves, so that the distance from the reference bounds them instead of E. `edge`: a usual one,
/// working coordinates.
BlockRules relaxed_rules(const BlockRules& rules, double edge);

}  // namespace tetwright

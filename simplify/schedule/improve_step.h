// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/schedule/block_runner.h"

namespace tetwright {

/// Bounds of shape_quality() below which a tet is worked on, and below which its points may leave the
/// surface.
struct ImproveBounds {
  float bad_quality, leave_surface;
};

/// The rules of an improvement step.
struct ImproveRules {
  const BlockRules& rules;
  const BlockRules& relaxed;  ///< relaxed_rules(), for edge removals and collapses
  ImproveBounds bounds;
  bool last_resort;  ///< points of tets worse than bounds.leave_surface also move by `relaxed`
  bool flips_first;  ///< before smoothing: half the time, but less gain in thin layers of many materials
};

/// One improvement step at a tet: tries operations until one improves the worst tet around.
Outcome improve_tet(Workspace& ws, const ImproveRules& step, const TetSnapshot& item);

/// Tries a random flip of the tet that leaves only good tets (Acceptance::good_enough) or improves the worst:
/// this changes the connectivity near tets that no operation improves.
Outcome perturb_tet(Workspace& ws, const BlockRules& perturbation, const TetSnapshot& item);

/// Rules for edge removals and for collapses that cut off an ear. These sweep a large volume although the
/// surface hardly moves, so they are bounded by the distance from the reference instead of E.
///
/// \param edge usual edge length, working coordinates.
BlockRules relaxed_rules(const BlockRules& rules, double edge);

}  // namespace tetwright

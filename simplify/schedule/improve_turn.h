#pragma once

#include "simplify/schedule/block_runner.h"

namespace tetwright {

/// Qualities (shape_quality()) below which a tet is worked on, and points may leave the surface for it.
struct ImproveBounds {
  float poor, leave_surface;
};

/// What a tet's turn may do.
struct ImproveRules {
  const BlockRules& rules;
  const BlockRules& surgery;  ///< of edge removals and collapses: surgery_rules()
  ImproveBounds bounds;
  bool last_resort;  ///< points of tets worse than bounds.leave_surface move by `surgery`, too
  bool flips_first;  ///< before better places: half the time, but less gain in thin layers of many materials
};

/// One tet's turn: the first action that makes the worst tet around better ends it.
Outcome improve_tet(Workspace& ws, const ImproveRules& turn, const ListedTet& item);

/// A flip of the tet, chosen at random, that leaves only good tets (BlockRules::good_enough) or an
/// improvement: it changes the connectivity near tets that no operation improves.
Outcome perturb_tet(Workspace& ws, const BlockRules& perturbation, const ListedTet& item);

/// Rules of collapses that cut off an ear and of edge removal. They sweep much volume though the surface
/// hardly moves, so that the distance from the reference bounds them instead of E. `edge`: a usual one,
/// working coordinates.
BlockRules surgery_rules(const BlockRules& rules, double edge);

}  // namespace tetwright

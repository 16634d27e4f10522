// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "simplify/schedule/improvement_area.h"
#include "simplify/schedule/round_recorder.h"

namespace tetwright {

struct ImprovementPlan {
  const char* kind;  ///< of its rounds in the report
  /// Steradians: tets whose shape is worse than shape_quality_bound() of it are worked on.
  double angle;
  /// Likewise: for tets worse than this, points of the surface may leave it a little.
  double leave_surface_angle;
  std::size_t target_tets, min_tets, max_tets;
  /// Flips before better places, and the last resort as soon as a round gains little but not much is bad:
  /// half the time of improve(), but less gain where thin layers of many materials keep most points from
  /// moving far. Else the first round perturbs: after a simplification that gives better shapes on nearer
  /// surfaces.
  bool fast;
  /// Ends as soon as a round gains little and no tet is below leave_surface_angle: the last ones of those
  /// that are better take as long as all others.
  bool brief;
  int max_rounds;
};

/// What an improvement works with.
struct ImprovementTools {
  EditableMesh& mesh;
  BlockRunner& runner;
  BlockRules& rules;
  RoundRecorder& recorder;
};

/// Improves the shapes of the worst tets, worst first (README.md, Improvement). The mesh is compacted and
/// rated by shape. Returns the number of rounds it took. Throws Interrupted and OutOfTime.
int run_improvement(const ImprovementTools& tools, ImprovementArea& area, const ImprovementPlan& plan);

}  // namespace tetwright

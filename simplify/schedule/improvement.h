// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "simplify/schedule/improvement_area.h"
#include "simplify/schedule/round_recorder.h"

namespace tetwright {

struct ImprovementPlan {
  const char* kind;  ///< kind of its rounds in the report
  /// Steradians: tets worse than the shape_quality_bound() of this angle are worked on.
  double angle;
  /// Likewise: for tets worse than this, points of the surface may leave it slightly.
  double leave_surface_angle;
  std::size_t target_tets, min_tets, max_tets;
  /// Flips before smoothing, and uses the last resort as soon as a round gains little and few tets are bad.
  /// Takes half the time of improve(), but gains less if thin layers of many materials prevent most points
  /// from moving far. If false, the first round perturbs, which gives better shapes and smaller surface
  /// distances after a simplification.
  bool fast;
  /// Ends as soon as a round gains little and no tet is below leave_surface_angle, since the last bad tets
  /// above it take as long as all others.
  bool brief;
  int max_rounds;
};

/// The objects that an improvement works with.
struct ImprovementTools {
  EditableMesh& mesh;
  BlockRunner& runner;
  BlockRules& rules;
  RoundRecorder& recorder;
};

/// Improves the shapes of the worst tets, worst first (README.md, Improvement).
///
/// \return number of rounds.
/// \throws Interrupted, OutOfTime.
/// \pre The mesh is compacted and rated by shape.
int run_improvement(const ImprovementTools& tools, ImprovementArea& area, const ImprovementPlan& plan);

}  // namespace tetwright

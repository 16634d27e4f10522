#pragma once

#include <cstddef>

#include "simplify/schedule/engine.h"

namespace tetwright {

struct ImprovementPlan {
  const char* kind;  ///< of its rounds in the report
  /// Steradians: tets whose shape is worse than shape_quality_bound() of it are worked on.
  double angle;
  /// Likewise: for tets worse than this, points of the surface may leave it a little.
  double leave_surface_angle;
  std::size_t target_tets, min_tets, max_tets;
  bool local;  ///< only near such tets: no room for insertions is made elsewhere
  /// Flips before better places, and the last resort as soon as a round gains little: half the time of
  /// improve(), but less gain where thin layers of many materials keep most points from moving far.
  bool fast;
  int max_rounds;
  int fit_sweeps;  ///< of fit_to_surface() over all interface points, before the rounds
};

/// Compacts the mesh, rates its tets by their shapes and sets the rules that all improvement shares: before
/// the first run_bulk_improvement() or run_improvement().
void begin_improvement(Engine& engine);

/// Improves the shapes of the worst tets, worst first (README.md, Improvement). Returns the number of rounds
/// it took. Throws Interrupted.
int run_improvement(Engine& engine, const ImprovementPlan& plan);

}  // namespace tetwright

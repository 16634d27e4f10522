#pragma once

#include <cstddef>
#include <vector>

#include "simplify/schedule/engine.h"

namespace tetwright {

/// What an improvement works on: the whole mesh, or a part of it. Only while no task runs.
class ImprovementArea {
 public:
  virtual ~ImprovementArea() = default;
  /// The number of its tets, which shares are of.
  virtual std::size_t tet_count() const = 0;
  /// A usual edge, working coordinates.
  virtual double usual_edge() const = 0;
  // Ascending, which is the order of the curve after compaction.

  /// The tets of at most that quality.
  virtual std::vector<ListedTet> poor_tets(float limit) = 0;
  /// The tets that share a point with a listed one, and their points.
  virtual std::vector<ListedTet> tets_around(const std::vector<ListedTet>& tets) = 0;
  virtual std::vector<Index> points_around(const std::vector<ListedTet>& tets) = 0;
  /// The points at which collapses may make room for insertions near poor tets.
  virtual std::vector<Index> points_to_thin(const std::vector<ListedTet>& poor) = 0;
};

struct ImprovementPlan {
  const char* kind;  ///< of its rounds in the report
  /// Steradians: tets whose shape is worse than shape_quality_bound() of it are worked on.
  double angle;
  /// Likewise: for tets worse than this, points of the surface may leave it a little.
  double leave_surface_angle;
  std::size_t target_tets, min_tets, max_tets;
  /// Flips before better places, and the last resort as soon as a round gains little but not much is poor:
  /// half the time of improve(), but less gain where thin layers of many materials keep most points from
  /// moving far. Else the first round perturbs: after a simplification that gives better shapes on nearer
  /// surfaces.
  bool fast;
  /// Ends as soon as a round gains little and no tet is below leave_surface_angle: the last ones of those
  /// that are better take as long as all others.
  bool brief;
  int max_rounds;
  int fit_sweeps;  ///< of fit_to_surface() over all interface points, before the rounds
};

/// Compacts the mesh, rates its tets by their shapes and sets the rules that all improvement shares: before
/// the first run_bulk_improvement() or run_improvement().
void begin_improvement(Engine& engine);

/// What an improvement works with.
struct ImprovementTools {
  EditableMesh& mesh;
  BlockRunner& runner;
  BlockRules& rules;
  Engine* engine;  ///< gets the report and the progress; null: nobody asks
};

/// Improves the shapes of the worst tets, worst first (README.md, Improvement). Returns the number of rounds
/// it took. Throws Interrupted.
int run_improvement(const ImprovementTools& tools, ImprovementArea& area, const ImprovementPlan& plan);
/// The same of a part of an engine's mesh; of the whole where `area` is null.
int run_improvement(Engine& engine, const ImprovementPlan& plan, ImprovementArea* area = nullptr);

}  // namespace tetwright

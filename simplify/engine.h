#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "simplify/block.h"
#include "simplify/simplify.h"

namespace tetwright {

/// What the schedules share: the mesh with its grid and tasks, the choice of the poor, the report.
class Engine {
 public:
  struct Options {
    std::string name;
    double target_tets;  ///< for the ideal sizes of Quality(t)
    double beta, gamma;
    std::uint64_t seed;
    std::size_t chunk_size;
    ShapeObjective objective;
    const ReferenceSurface* reference;
    bool keep_volumes = true;  ///< by a VolumeLedger
  };
  Engine(TetMesh&& mesh, const Options& options, SimplifyReport* report, Progress* progress);
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Ends the work; the mesh with its interface triangles.
  TetMesh take() &&;

  EditableMesh& mesh() { return mesh_; }
  BlockRunner& runner() { return runner_; }
  const Slide& slide() const { return slide_; }
  const VolumeLedger& ledger() const { return ledger_; }
  Progress* progress() { return progress_; }
  BlockRules rules;

  void begin_stage(const char* name);
  /// Compaction, and all that holds indices or qualities anew; slots are left for operations that add. Every
  /// schedule begins with it, once it has set its objective.
  void squeeze();
  /// squeeze() where so many slots are dead that it pays.
  void squeeze_if_sparse();
  /// Every tet's quality by rules.objective.
  void rate_all();

  // Only while no task runs. Parallel; the results do not depend on the threads.

  /// The quality below which `percent` of the tets lie; 1 if all.
  float cutoff(double percent) const;
  /// The tets of at most that quality, in the order of the curve.
  std::vector<ListedTet> poor_tets(float limit) const;
  /// The points of these tets, each once, in the order of the curve.
  std::vector<Index> poor_points(float limit) const;
  /// The tets that share a point with a listed one, in the order of the curve, and their points, each once.
  std::vector<ListedTet> tets_around(const std::vector<ListedTet>& tets) const;
  std::vector<Index> points_around(const std::vector<ListedTet>& tets) const;
  /// The points of boundary and interfaces, in the order of the curve.
  std::vector<Index> interface_points() const;

  /// One try at each of the points with an operation on its star, which may answer anything; `stop` is asked
  /// before each.
  void each_star(
      const std::vector<Index>& points, Operation kind, const std::function<Outcome(Task&)>& operation,
      const std::function<bool()>& stop = [] { return false; });
  /// fit_to_surface() for all interface points.
  void fit_interfaces(float floor);

  /// Times a round of the schedule and takes down what its tasks counted.
  class Round {
   public:
    Round(Engine& engine, const char* kind);
    IterationReport& report() { return report_; }
    /// Into the engine's report.
    void finish();

   private:
    Engine& engine_;
    IterationReport report_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  };

 private:
  /// The points for which mark(tet, its record, place in it) holds for some tet.
  template <class Mark>
  std::vector<Index> marked_points(const Mark& mark) const;
  /// The living tets whose record passes the test, in the order of the curve.
  template <class Test>
  std::vector<ListedTet> tets_where(const Test& test) const;
  /// 1 for the points of the listed tets.
  std::vector<std::uint8_t> points_of(const std::vector<ListedTet>& tets) const;

  SimplifyReport* report_;
  Progress* progress_;
  EditableMesh mesh_;
  SurfaceGrid grid_;
  VolumeLedger ledger_;
  Slide slide_;
  BlockRunner runner_;
};

double seconds_since(std::chrono::steady_clock::time_point start);

/// Share of the tets by which the block loop stops above the target, and by which the closing may end below
/// it: collapses are what removes the last slivers on flat boundaries. Together they keep the count well
/// within 1 %.
inline constexpr double closing_slack = 0.006;

// What both schedules have of the paper, or of what it leaves open.

inline constexpr double percent_step = 10;  ///< the share of poor tets grows by this each iteration
/// Probability at first of an action that leaves a poorer tet, where the paper allows such "early in
/// computation": p0 of p0 ln(n/N) / ln(n0/N).
inline constexpr double first_annealing = 0.3;
/// E stops growing here, in working coordinates, of which the farthest is below 2, for gamma 10: beyond it
/// nothing is refused any more.
inline constexpr double largest_useful_error = 200;
/// Iterations in a row that gain less than that share of the tets before a loop ends.
inline constexpr int most_idle_iterations = 3;
inline constexpr double idle_below = 0.003;

/// The block loop with the tuned schedule (README.md, Schedule), down to the target.
void run_tuned_schedule(Engine& engine, const SimplifyOptions& options);

/// Figure 3 of the paper.
void run_paper_schedule(Engine& engine, const SimplifyOptions& options);

/// How improvement works.
struct ImprovementPlan {
  const char* kind;  ///< of its rounds in the report
  double angle;  ///< steradians: tets whose shape is poorer than shape_quality_bound() of it are worked on
  double leave_surface_angle;  ///< the same: for these points of the surface may leave it a little
  std::size_t target_tets, fewest_tets, most_tets;
  bool local;  ///< only where such tets are: no room for insertions is made elsewhere
  int most_rounds;
  int fit_sweeps;  ///< over all interface points, before (fit_to_surface())
};

/// Improves the shapes of the poorest tets, worst first (README.md, Improvement). The number of rounds it
/// took.
int run_improvement(Engine& engine, const ImprovementPlan& plan);

}  // namespace tetwright

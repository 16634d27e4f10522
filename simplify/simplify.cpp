#include "simplify/simplify.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "common/memory.h"
#include "simplify/schedule/bulk_improvement.h"
#include "simplify/schedule/engine.h"
#include "simplify/schedule/improvement.h"
#include "simplify/schedule/paper_schedule.h"
#include "simplify/schedule/schedule_constants.h"
#include "simplify/schedule/tuned_schedule.h"

namespace tetwright {

namespace {

/// Rounds that close simplify().
constexpr int max_closing_rounds = 40;
/// The closing works on tets whose quality is below this many times the bound: dihedral angles up to 25
/// degrees.
constexpr double closing_margin = 1.27;
/// For tets worse than this multiple of the bound, improve() may move points off the surface (dihedral angles
/// up to 30 degrees). In the closing that would move the surface a quarter farther.
constexpr double improve_margin = 1.5;
constexpr int closing_fit_sweeps = 1;
/// Rounds of improve() in bulk, before those that take the worst tets first.
constexpr int max_bulk_rounds = 30;
/// The first bound on the way there, for a --min-solid-angle of next to nothing.
constexpr double min_first_bound = 1e-3;
/// Factor from one bound to the next.
constexpr double improve_step = 1.18;
/// Share of the tets that improve() may add or take away; 5 % are promised.
constexpr double improve_slack = 0.045;
/// E of improve(), in edges of a regular mesh of that count: the paper's first E.
constexpr double improve_error_edges = 1;

/// Peak memory of the process: its libraries, and the editable mesh with what it is made from, for each tet
/// of the input. README.md, Memory, compares it with what was measured.
constexpr double program_bytes = 40e6;
constexpr double bytes_per_tet = 105;

/// Checks what both calls share, before any work.
void check(const TetMesh& mesh, const std::string& name) {
  if (mesh.tets.empty()) throw InputError(name, 0, "no tets in it");
  require_memory(program_bytes + bytes_per_tet * static_cast<double>(mesh.tets.size()),
                 name + ": work on its " + std::to_string(mesh.tets.size()) + " tets",
                 "free some, or use a machine or a container limit with more");
}

}  // namespace

TetMesh simplify(TetMesh mesh, const SimplifyOptions& options, SimplifyReport* report, Progress* progress) {
  if (options.target_tets == 0) throw UsageError("a target of 0 tets leaves nothing; give 1 or more");
  if (!(options.beta > 0) || !(options.gamma >= 0))
    throw UsageError("beta must be above 0 and gamma at least 0");
  check(mesh, options.name);
  const auto start = std::chrono::steady_clock::now();
  const std::size_t first_count = mesh.tets.size();
  Engine engine(std::move(mesh),
                {options.name, static_cast<double>(options.target_tets), options.beta, options.gamma,
                 options.seed, options.batch_size, options.objective, options.reference, options.frozen,
                 options.fix_boundary, options.schedule == Schedule::tuned},
                report, progress);
  engine.begin_stage("simplify");
  const double build = seconds_since(start);
  if (options.schedule == Schedule::paper) {
    run_paper_schedule(engine, options);
  } else {
    run_tuned_schedule(engine, options);
  }
  const double loop_end = seconds_since(start);
  if (options.schedule == Schedule::tuned) {
    engine.begin_stage("improve");
    begin_improvement(engine);
    const auto count = static_cast<double>(std::min(options.target_tets, first_count));
    run_improvement(engine, {.kind = "close",
                             .angle = closing_margin * options.min_solid_angle,
                             .leave_surface_angle = closing_margin * options.min_solid_angle,
                             .target_tets = static_cast<std::size_t>(count),
                             .min_tets = static_cast<std::size_t>(std::ceil(count * (1 - closing_slack))),
                             .max_tets = static_cast<std::size_t>(count * (1 + closing_slack)),
                             .local = false,
                             .max_rounds = max_closing_rounds,
                             .fit_sweeps = closing_fit_sweeps});
  }
  if (report) {
    report->touching_points = engine.mesh().touching_points();
    report->seconds_build = build;
    report->seconds_simplify = loop_end - build;
    report->seconds_close = seconds_since(start) - loop_end;
  }
  return std::move(engine).take();
}

TetMesh improve(TetMesh mesh, const ImproveOptions& options, SimplifyReport* report, Progress* progress) {
  check(mesh, options.name);
  const auto start = std::chrono::steady_clock::now();
  const auto count = static_cast<double>(mesh.tets.size());
  const SimplifyOptions defaults;
  Engine engine(std::move(mesh),
                {options.name, count, defaults.beta, defaults.gamma, options.seed, options.batch_size,
                 options.objective, options.reference, options.frozen, options.fix_boundary},
                report, progress);
  engine.begin_stage("improve");
  const double build = seconds_since(start);
  engine.rules.max_error = improve_error_edges * engine.rules.objective.quality.ideal_edge;
  begin_improvement(engine);
  const auto min_tets = static_cast<std::size_t>(std::ceil(count * (1 - improve_slack)));
  const auto max_tets = static_cast<std::size_t>(count * (1 + improve_slack));
  const double below = options.only_below > 0 ? options.only_below : improve_margin * options.min_solid_angle;
  // The worst first, also in the large: a bound that most tets are below would leave no time for them.
  int rounds = options.max_iterations;
  double limit = std::min(below, std::max(min_first_bound, closing_margin * options.min_solid_angle));
  const auto poor = static_cast<float>(shape_quality_bound(options.objective, limit));
  rounds -=
      run_bulk_improvement(engine, {"improve", poor, min_tets, max_tets, std::min(rounds, max_bulk_rounds)});
  for (; rounds > 0; limit *= improve_step) {
    limit = std::min(limit, below);
    rounds -= run_improvement(engine, {.kind = "improve",
                                       .angle = limit,
                                       .leave_surface_angle = improve_margin * options.min_solid_angle,
                                       .target_tets = static_cast<std::size_t>(count),
                                       .min_tets = min_tets,
                                       .max_tets = max_tets,
                                       .local = options.only_below > 0,
                                       .max_rounds = rounds,
                                       .fit_sweeps = 0});
    if (limit >= below) break;
  }
  if (report) {
    report->touching_points = engine.mesh().touching_points();
    report->seconds_build = build;
    report->seconds_close = seconds_since(start) - build;
  }
  return std::move(engine).take();
}

}  // namespace tetwright

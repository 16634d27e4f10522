#include "simplify/simplify.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "common/memory.h"
#include "simplify/remesh/local_area.h"
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
/// Rounds in bulk each time.
constexpr int max_bulk_rounds = 30;
/// Shares of the tets below the bound above which improve() begins in bulk, and from which on whatever stays
/// below it after rounds for the worst is taken up in bulk. Scans and what programs make of them have up to
/// 32 % below 0.15 sr at first, and the rounds alone end them in half the time.
constexpr double bulk_before = 0.4;
constexpr double bulk_after = 0.01;
/// In the end improve() takes up all tets below this solid angle, steradians, by the cheap operations alone:
/// the mean rises by 0.01 sr. The rounds would take four times as long as all before for as much again.
constexpr double polish_below = 0.2;
constexpr int max_polish_rounds = 3;
/// Rounds kept for that and for what comes after it.
constexpr int max_last_rounds = 20;
/// Factors by which the count may change with ImproveOptions::free_count, so that detail is not lost by the
/// way and no mesh grows for ever.
constexpr double min_free = 0.8, max_free = 4;
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

float quality_at(const Engine& engine, double angle) {
  return static_cast<float>(shape_quality_bound(engine.rules.objective.shape, angle));
}

/// Works in bulk on what is below an angle; returns the number of rounds.
int improve_in_bulk(Engine& engine, const ImprovementPlan& plan, double angle, int max_rounds, bool remodel) {
  return run_bulk_improvement(engine, {.kind = plan.kind,
                                       .poor = quality_at(engine, angle),
                                       .min_tets = plan.min_tets,
                                       .max_tets = plan.max_tets,
                                       .max_rounds = std::min(plan.max_rounds, max_rounds),
                                       .remodel = remodel});
}

/// What improve_to_angle() looks at for rounds of the worst tets: lists that follow what changes, where all
/// but a few tets are left alone; where the count is held by collapses anywhere, the whole mesh.
enum class RoundsOver { poor_tets, whole_mesh };

/// Improves what is below the plan's angle: the worst first, and in bulk before where more than `bulk_first`
/// of the tets are below it at first, or too many still are afterwards. Takes the rounds off plan.max_rounds.
void improve_to_angle(Engine& engine, ImprovementPlan& plan, double bulk_first, RoundsOver over) {
  for (const double bulk_above : {bulk_first, bulk_after}) {
    std::vector<ListedTet> poor = engine.poor_tets(quality_at(engine, plan.angle));
    const bool bulk =
        static_cast<double>(poor.size()) > bulk_above * static_cast<double>(engine.mesh().live_tets());
    const bool second = bulk_above == bulk_after;
    if (plan.max_rounds <= 0 || (second && !bulk)) return;
    if (bulk) {
      plan.max_rounds -= improve_in_bulk(engine, plan, plan.angle, max_bulk_rounds, true);
      poor = engine.poor_tets(quality_at(engine, plan.angle));
    }
    if (over == RoundsOver::poor_tets) {
      LocalArea area(engine.mesh(), engine.runner(), engine.rules.objective.quality.ideal_edge, poor);
      plan.max_rounds -= run_improvement(engine, plan, &area);
    } else {
      plan.max_rounds -= run_improvement(engine, plan);
    }
    plan.fit_sweeps = 0;
  }
}

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
    ImprovementPlan plan{.kind = "close",
                         .angle = closing_margin * options.min_solid_angle,
                         .leave_surface_angle = closing_margin * options.min_solid_angle,
                         .target_tets = static_cast<std::size_t>(count),
                         .min_tets = static_cast<std::size_t>(std::ceil(count * (1 - closing_slack))),
                         .max_tets = static_cast<std::size_t>(count * (1 + closing_slack)),
                         .fast = false,
                         .brief = false,
                         .max_rounds = max_closing_rounds,
                         .fit_sweeps = closing_fit_sweeps};
    improve_to_angle(engine, plan, 1, RoundsOver::whole_mesh);
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
  const double below = options.only_below > 0 ? options.only_below : improve_margin * options.min_solid_angle;
  const double least = options.free_count ? min_free : 1 - improve_slack;
  const double most = options.free_count ? max_free : 1 + improve_slack;
  // The last rounds are kept for what comes in the end.
  const int kept_rounds = options.only_below > 0 ? 0 : std::min(options.max_iterations / 2, max_last_rounds);
  ImprovementPlan plan{.kind = "improve",
                       .angle = below,
                       .leave_surface_angle = improve_margin * options.min_solid_angle,
                       .target_tets = static_cast<std::size_t>(count),
                       .min_tets = static_cast<std::size_t>(std::ceil(count * least)),
                       .max_tets = static_cast<std::size_t>(count * most),
                       .fast = true,
                       .brief = false,
                       .max_rounds = options.max_iterations - kept_rounds,
                       .fit_sweeps = 0};
  const RoundsOver over = options.only_below > 0 ? RoundsOver::poor_tets : RoundsOver::whole_mesh;
  // The worst first, also in the large: a bound that most tets are below would leave no time for them.
  for (double limit = std::max(min_first_bound, closing_margin * options.min_solid_angle);;
       limit *= improve_step) {
    plan.angle = std::min(limit, below);
    improve_to_angle(engine, plan, bulk_before, over);
    if (limit >= below || plan.max_rounds <= 0) break;
  }
  plan.max_rounds += kept_rounds;
  if (over == RoundsOver::whole_mesh && plan.max_rounds > 0) {
    plan.max_rounds -= improve_in_bulk(engine, plan, std::max(below, polish_below), max_polish_rounds, false);
    // Other connectivity around them lets the last ones go on.
    if (plan.max_rounds > 0) run_improvement(engine, plan);
  }
  if (report) {
    report->touching_points = engine.mesh().touching_points();
    report->seconds_build = build;
    report->seconds_close = seconds_since(start) - build;
  }
  return std::move(engine).take();
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "simplify/simplify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "common/error.h"
#include "common/memory.h"
#include "common/mesh/interfaces.h"
#include "common/message_text.h"
#include "simplify/constraints/surface_samples.h"
#include "simplify/remesher.h"
#include "simplify/schedule/bulk_improvement.h"
#include "simplify/schedule/edge_length_adaptation.h"
#include "simplify/schedule/engine.h"
#include "simplify/schedule/improve_area.h"
#include "simplify/schedule/local_refinement.h"
#include "simplify/schedule/paper_schedule.h"
#include "simplify/schedule/schedule_constants.h"
#include "simplify/schedule/tuned_schedule.h"

namespace tetwright {

namespace {

/// Share of the time limit, if there is one, that the loop may use. The closing takes about as long as the
/// last fifth of the loop.
constexpr double loop_time_share = 0.75;
/// Share that loop and closing may use together if the result is compared with a tolerance.
constexpr double changing_time_share = 0.8;
/// Max rounds of the closing of simplify().
constexpr int max_closing_rounds = 40;
/// Multiple of the bound below which the closing works on tets: dihedral angles up to 25 degrees.
constexpr double closing_margin = 1.27;
/// Multiple of the bound below which improve() may move points off the surface for a tet: dihedral angles up
/// to 30 degrees. In the closing that would move the surface a quarter farther.
constexpr double improve_margin = 1.5;
/// Max relative change of the count in the closing if no count was asked for.
constexpr double free_closing_slack = 1;
constexpr int sweeps_before_closing = 1, sweeps_after_closing = 2;
/// Sweeps of fit_to_crease() before the closing.
constexpr int crease_sweeps = 3;
/// Share of bad tets above which improve() begins in bulk. Scans and results of other programs initially have
/// up to 32 % of tets below 0.15 sr; on these, improvement without bulk takes half the time.
constexpr double bulk_before = 0.4;
/// Solid angle, steradians, below which improve() finally works on all tets, with cheap operations only: the
/// mean rises by 0.01 sr. The rounds would take four times as long as everything before to gain that much
/// again.
constexpr double polish_below = 0.2;
constexpr int max_polish_rounds = 3;
/// Max rounds reserved for that and for the rounds after it.
constexpr int max_last_rounds = 20;
/// Another call of the Remesher is made only if the last one left less than this fraction of the bad tets.
constexpr double min_call_gain = 0.95;
/// Min and max factor on the count with ImproveOptions::free_count, so that no detail is lost on the way and
/// no mesh grows for ever.
constexpr double min_free = 0.8, max_free = 4;
/// Min value of the first bound, for a --min-solid-angle of nearly 0.
constexpr double min_first_bound = 1e-3;
/// Max relative change of the count in improve(); 5 % are promised.
constexpr double improve_slack = 0.045;
/// E of improve(), in edges of a regular mesh of that count: the paper's initial E.
constexpr double improve_error_edges = 1;

/// Estimate of the process's peak memory: its libraries, and for each input tet the editable mesh with the
/// input that it is made from. README.md, Memory, compares it with measurements.
constexpr double program_bytes = 40e6;
constexpr double bytes_per_tet = 105;

float quality_at(const Engine& engine, double angle) {
  return static_cast<float>(shape_quality_bound(engine.rules.objective.shape, angle));
}

ImprovementTools tools_of(Engine& engine) {
  return {engine.mesh(), engine.runner(), engine.rules, engine.recorder()};
}

/// Sweeps of fit_to_samples() over all interface points.
void fit(Engine& engine, int sweeps, float floor) {
  for (int i = 0; i < sweeps; ++i) {
    RoundRecorder::Round round(engine.recorder(), "close", engine.rules.max_error);
    engine.fit_interfaces(floor);
    round.finish();
  }
}

/// First of the rising bounds.
double first_bound(double min_solid_angle) {
  return std::max(min_first_bound, closing_margin * min_solid_angle);
}

/// Checks shared by both calls, before any work.
void check(const TetMesh& mesh, const std::string& name) {
  if (mesh.tets.empty()) throw InputError(name, 0, "no tets in it");
  require_memory(program_bytes + bytes_per_tet * static_cast<double>(mesh.tets.size()),
                 name + ": work on its " + std::to_string(mesh.tets.size()) + " tets",
                 "free some, or use a machine or a container limit with more");
}

/// Number of tets that follows from target lengths, or that their bounds allow.
std::size_t target_for_sizes(const Engine& engine, const SimplifyOptions& options) {
  double tets = static_cast<double>(options.target_tets);
  if (options.sizes)
    tets = engine.tets_for_sizes();
  else if (options.target_tets > 0)
    tets = std::max(std::min(tets, engine.tets_for_edge(within_bounds * options.min_edge)),
                    engine.tets_for_edge(options.max_edge / within_bounds));
  require_memory(program_bytes + bytes_per_tet * tets,
                 options.name + ": about " + short_number(tets) + " tets with edges of the wanted lengths",
                 "give larger ones");
  return options.target_tets == 0 && !options.sizes ? 0 : static_cast<std::size_t>(std::max(1.0, tets));
}

void check_options(const SimplifyOptions& options) {
  if (options.target_tets == 0 &&
      !((options.tolerance > 0 || options.sizes) && options.schedule == Schedule::tuned))
    throw UsageError("a target of 0 tets leaves nothing; give 1 or more");
  if (!(options.min_edge >= 0) || !(options.max_edge > options.min_edge))
    throw UsageError("the max edge must be above the min edge, and that at least 0");
  if (!(options.tolerance >= 0)) throw UsageError("the tolerance must be at least 0");
  if (!(options.beta > 0) || !(options.gamma >= 0))
    throw UsageError("beta must be above 0 and gamma at least 0");
}

/// False if the deadline of `progress` ended the work. Changes made before are kept: a BlockRunner stops
/// between batches, when the mesh is whole.
template <class Work>
bool done_in_time(const Work& work) {
  try {
    work();
  } catch (const OutOfTime&) {
    return false;
  }
  return true;
}

/// Moves the deadline forward to this share of the remaining time for as long as it lives.
class EarlierDeadline {
 public:
  EarlierDeadline(Progress* progress, double share) : progress_(progress) {
    if (!progress_ || (deadline_ = progress_->deadline()) == Progress::no_deadline) return;
    const auto now = Progress::Clock::now();
    progress_->set_deadline(now +
                            std::chrono::duration_cast<Progress::Clock::duration>(share * (deadline_ - now)));
  }
  ~EarlierDeadline() {
    if (progress_) progress_->set_deadline(deadline_);
  }
  EarlierDeadline(const EarlierDeadline&) = delete;
  EarlierDeadline& operator=(const EarlierDeadline&) = delete;

 private:
  Progress* progress_;
  Progress::Clock::time_point deadline_ = Progress::no_deadline;
};

bool out_of_time(const Progress* progress) { return progress && progress->out_of_time(); }

/// Result of improve() if the deadline has passed before any change.
TetMesh unchanged(TetMesh mesh, SimplifyReport* report) {
  if (mesh.interfaces.empty()) mesh.interfaces = find_interfaces(mesh);
  if (report) report->out_of_time = true;
  return mesh;
}

/// Result of simplify() then: the distance from the surface is measured all the same.
TetMesh not_simplified(TetMesh mesh, const SimplifyOptions& options, SimplifyReport* report,
                       const Progress* progress) {
  if (options.tolerance > 0 && report)
    report->deviation = options.surface ? deviation(mesh, *options.surface, progress) : DeviationReport();
  return unchanged(std::move(mesh), report);
}

bool is_bounded(const SimplifyOptions& options) {
  return options.sizes || options.min_edge > 0 || std::isfinite(options.max_edge);
}

/// The improvement that closes the tuned schedule.
///
/// \param target number of tets; 0: the current one.
/// \param deviation set if that of the result is known.
void close(Engine& engine, const SimplifyOptions& options, std::size_t target, std::size_t first_count,
           std::optional<DeviationReport>& deviation) {
  const bool bounded = is_bounded(options);
  engine.begin_improvement();
  if (bounded) {
    WholeMesh whole(engine);
    adapt_edge_lengths(tools_of(engine), whole,
                       {.kind = "close",
                        .angle = closing_margin * options.min_solid_angle,
                        .min_tets = 1,
                        .max_tets = std::numeric_limits<std::int64_t>::max()});
  }
  const auto near_target = [&](std::size_t tets) {
    return std::fabs(static_cast<double>(tets) - static_cast<double>(target)) <=
           closing_slack * static_cast<double>(target);
  };
  const bool counted = target > 0 && !options.sizes && (!bounded || near_target(engine.mesh().live_tets()));
  const auto count = static_cast<double>(counted ? std::min(target, first_count) : engine.mesh().live_tets());
  // Without a count, better shapes are worth more tets, and edges shorter than the target length.
  const double slack = counted ? closing_slack : free_closing_slack;
  if (options.sizes) engine.allow_shorter_edges();
  const ImprovementPlan plan{.kind = "close",
                             .angle = closing_margin * options.min_solid_angle,
                             .leave_surface_angle = closing_margin * options.min_solid_angle,
                             .target_tets = static_cast<std::size_t>(count),
                             .min_tets = static_cast<std::size_t>(std::ceil(count * (1 - slack))),
                             .max_tets = static_cast<std::size_t>(count * (1 + slack)),
                             .fast = false,
                             .brief = false,
                             .max_rounds = max_closing_rounds};
  // After a point has arrived, its neighbours may have more room.
  for (int i = 0; i < crease_sweeps; ++i) engine.fit_creases();
  fit(engine, sweeps_before_closing, quality_at(engine, plan.angle));
  WholeMesh whole(engine);
  improve_area(tools_of(engine), whole, plan, 1);
  if (!counted) refine_bad_tets(tools_of(engine), whole, plan, options.min_solid_angle);
  // Better shapes have cost fit.
  fit(engine, sweeps_after_closing, quality_at(engine, plan.angle));
  // Fitting may cost a tet that is just above the bound.
  if (!counted) refine_bad_tets(tools_of(engine), whole, plan, options.min_solid_angle);
  if (options.tolerance == 0) return;
  deviation = engine.deviation();
  if (deviation->upper() <= options.tolerance) return;
  engine.throw_if_stopped();
  deviation.reset();
  // If the tolerance has held the count back in the loop, it may do so here.
  ImprovementPlan holding = plan;
  const auto live = static_cast<double>(engine.mesh().live_tets());
  if (live > static_cast<double>(plan.max_tets))
    holding.max_tets = static_cast<std::size_t>(live * (1 + free_closing_slack));
  refine_beyond_tolerance(
      engine, whole, holding, options.min_solid_angle,
      options.tolerance * engine.mesh().space().scale() / (1 + relative_deviation_accuracy));
}

}  // namespace

TetMesh simplify(TetMesh mesh, const SimplifyOptions& options, SimplifyReport* report, Progress* progress) {
  check_options(options);
  check(mesh, options.name);
  if (out_of_time(progress)) return not_simplified(std::move(mesh), options, report, progress);
  const bool tuned = options.schedule == Schedule::tuned;
  const auto start = std::chrono::steady_clock::now();
  const std::size_t first_count = mesh.tets.size();
  Engine engine(
      std::move(mesh),
      {options.name, static_cast<double>(options.target_tets > 0 ? options.target_tets : first_count),
       options.beta, options.gamma, options.seed, options.batch_size, options.objective, options.reference,
       options.frozen, options.fix_boundary, tuned},
      report, progress);
  std::size_t target = options.target_tets;
  if (is_bounded(options) && tuned) {
    engine.set_sizes(options.sizes, options.min_edge, options.max_edge);
    target = target_for_sizes(engine, options);
    if (target != options.target_tets)
      engine.rules.objective.quality =
          TetQuality::for_target(engine.mesh().total_volume(), static_cast<double>(target), options.beta);
  }
  // Each step takes a good part of the time for a mesh that is large for its limit.
  const bool built = done_in_time([&] {
    engine.throw_if_stopped();
    if (tuned) engine.compact();
    engine.throw_if_stopped();
    if (tuned) engine.keep_input_surface(options.surface, options.tolerance > 0);
  });
  const double build = seconds_since(start);
  if (report) report->seconds_build = build;
  if (!built) return not_simplified(std::move(engine).take(), options, report, progress);
  std::optional<DeviationReport> deviation;
  bool in_time = true;
  double loop_end = build;
  {
    const EarlierDeadline measuring_has_time(progress, options.tolerance > 0 ? changing_time_share : 1);
    in_time = done_in_time([&] {
      const EarlierDeadline closing_has_time(progress, tuned ? loop_time_share : 1);
      engine.recorder().begin_stage("simplify");
      if (tuned)
        run_tuned_schedule(engine, options, target);
      else
        run_paper_schedule(engine, options);
    });
    loop_end = seconds_since(start);
    if (tuned) {
      // A count that was not reached is no target for the closing.
      const std::size_t closing_target = in_time ? target : engine.mesh().live_tets();
      in_time &= done_in_time([&] {
        engine.recorder().begin_stage("improve");
        close(engine, options, closing_target, first_count, deviation);
      });
    }
  }
  if (options.tolerance > 0 && !deviation) {
    engine.recorder().begin_stage("compare");
    deviation = engine.deviation();
  }
  if (report) {
    report->deviation = deviation;
    report->out_of_time = !in_time;
    report->touching_points = engine.mesh().touching_points();
    report->seconds_simplify = loop_end - build;
    report->seconds_close = seconds_since(start) - loop_end;
  }
  return std::move(engine).take();
}

DeviationReport deviation(const TetMesh& mesh, const TriangleMesh& surface, const Progress* progress) {
  const EditableMesh editable(TetMesh(mesh), "mesh");
  InputSurface input(editable, &surface);
  input.find_hidden(editable);
  return input.deviation(editable, progress);
}

namespace {

/// improve() with `only_below`: a Remesher works on the regions of bad tets only.
TetMesh improve_bad_regions(TetMesh&& mesh, const ImproveOptions& options, std::size_t min_tets,
                            std::size_t max_tets, SimplifyReport* report, Progress* progress) {
  const auto start = std::chrono::steady_clock::now();
  const std::size_t count = mesh.tets.size();
  Remesher remesher(std::move(mesh), {.objective = options.objective,
                                      .frozen = options.frozen,
                                      .fix_boundary = options.fix_boundary,
                                      .seed = options.seed,
                                      .name = options.name,
                                      .batch_size = options.batch_size,
                                      .reference = options.reference,
                                      .keep_surfaces = true,
                                      .report = report,
                                      .progress = progress});
  const double build = seconds_since(start);
  int rounds = options.max_iterations;
  const auto improve_up_to = [&](double angle) {
    const double bound = shape_quality_bound(options.objective, angle);
    // Each bound gets half of the remaining rounds, the last one all.
    const int kept = angle < options.only_below ? rounds / 2 : 0;
    for (double min_bad = std::numeric_limits<double>::infinity(); rounds > kept;) {
      std::vector<Index> bad;
      for (Index t = 0; t < remesher.tet_slots(); ++t)
        if (remesher.has_tet(t) && remesher.quality(t) <= bound) bad.push_back(t);
      if (bad.empty() || static_cast<double>(bad.size()) > min_call_gain * min_bad) break;
      min_bad = static_cast<double>(bad.size());
      const RemeshChanges changes =
          remesher.improve(RemeshRegion::tets(std::move(bad)),
                           {.angle = angle,
                            .leave_surface_angle = improve_margin * options.min_solid_angle,
                            .target_tets = count,
                            .min_tets = min_tets,
                            .max_tets = max_tets,
                            .brief = false,
                            .max_rounds = rounds - kept});
      rounds -= std::max(changes.rounds, 1);
    }
  };
  const bool in_time = done_in_time([&] {
    for (const double angle : rising_bounds(
             std::min(options.only_below, first_bound(options.min_solid_angle)), options.only_below))
      improve_up_to(angle);
  });
  if (report) {
    report->out_of_time = !in_time;
    report->touching_points = remesher.touching_points();
    report->seconds_build = build;
    report->seconds_close = seconds_since(start) - build;
  }
  return std::move(remesher).mesh();
}

}  // namespace

TetMesh improve(TetMesh mesh, const ImproveOptions& options, SimplifyReport* report, Progress* progress) {
  check(mesh, options.name);
  if (out_of_time(progress)) return unchanged(std::move(mesh), report);
  const auto start = std::chrono::steady_clock::now();
  const auto count = static_cast<double>(mesh.tets.size());
  const auto min_tets =
      static_cast<std::size_t>(std::ceil(count * (options.free_count ? min_free : 1 - improve_slack)));
  const auto max_tets = static_cast<std::size_t>(count * (options.free_count ? max_free : 1 + improve_slack));
  if (options.only_below > 0)
    return improve_bad_regions(std::move(mesh), options, min_tets, max_tets, report, progress);
  const SimplifyOptions defaults;
  Engine engine(std::move(mesh),
                {options.name, count, defaults.beta, defaults.gamma, options.seed, options.batch_size,
                 options.objective, options.reference, options.frozen, options.fix_boundary},
                report, progress);
  engine.recorder().begin_stage("improve");
  const double build = seconds_since(start);
  engine.rules.max_error = improve_error_edges * engine.rules.objective.quality.ideal_edge;
  const double below = improve_margin * options.min_solid_angle;
  // Reserve the last rounds for the end.
  const int kept_rounds = std::min(options.max_iterations / 2, max_last_rounds);
  ImprovementPlan plan{.kind = "improve",
                       .angle = below,
                       .leave_surface_angle = below,
                       .target_tets = static_cast<std::size_t>(count),
                       .min_tets = min_tets,
                       .max_tets = max_tets,
                       .fast = true,
                       .brief = false,
                       .max_rounds = options.max_iterations - kept_rounds};
  const ImprovementTools tools = tools_of(engine);
  WholeMesh whole(engine);
  const bool in_time = done_in_time([&] {
    engine.throw_if_stopped();
    engine.begin_improvement();
    for (const double bound : rising_bounds(first_bound(options.min_solid_angle), below)) {
      plan.angle = bound;
      plan.max_rounds -= improve_area(tools, whole, plan, bulk_before);
      if (plan.max_rounds <= 0) break;
    }
    plan.max_rounds += kept_rounds;
    if (plan.max_rounds <= 0) return;
    plan.max_rounds -= run_bulk_improvement(tools, whole,
                                            {.kind = plan.kind,
                                             .bad_quality = quality_at(engine, std::max(below, polish_below)),
                                             .min_tets = plan.min_tets,
                                             .max_tets = plan.max_tets,
                                             .max_rounds = std::min(plan.max_rounds, max_polish_rounds),
                                             .remodel = false});
    // Other connectivity around the last bad tets lets them improve further.
    if (plan.max_rounds > 0) run_improvement(tools, whole, plan);
  });
  if (report) {
    report->out_of_time = !in_time;
    report->touching_points = engine.mesh().touching_points();
    report->seconds_build = build;
    report->seconds_close = seconds_since(start) - build;
  }
  return std::move(engine).take();
}

}  // namespace tetwright

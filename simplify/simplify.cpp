// SPDX-License-Identifier: Apache-2.0
#include "tetwright/simplify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "common/message_text.h"
#include "simplify/constraints/surface_samples.h"
#include "simplify/mesh/input_check.h"
#include "simplify/schedule/bulk_improvement.h"
#include "simplify/schedule/edge_length_adaptation.h"
#include "simplify/schedule/engine.h"
#include "simplify/schedule/fitting_sweeps.h"
#include "simplify/schedule/improve_area.h"
#include "simplify/schedule/local_refinement.h"
#include "simplify/schedule/paper_schedule.h"
#include "simplify/schedule/tet_count.h"
#include "simplify/schedule/tuned_schedule.h"
#include "simplify/schedule/whole_mesh.h"
#include "simplify/tuning/tuning.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/remesher.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Closing = SimplifyTuning::Closing;
using Features = SimplifyTuning::Features;
using Improve = SimplifyTuning::Improve;
using Memory = SimplifyTuning::Memory;
using TimeLimit = SimplifyTuning::TimeLimit;

float quality_at(const Engine& engine, double angle) {
  return static_cast<float>(shape_quality_bound(engine.rules.objective.shape, angle));
}

ImprovementTools tools_of(Engine& engine) {
  return {engine.mesh(), engine.runner(), engine.rules, engine.recorder()};
}

/// Sweeps of fit_to_samples() over all interface points.
void fit(Engine& engine, int sweeps, float floor) {
  for (int i = 0; i < sweeps; ++i) {
    RoundRecorder::Round round(engine.recorder(), "close", engine.rules.error.limit());
    fit_interfaces(engine, floor);
    round.finish();
  }
}

/// First of the rising bounds.
double first_bound(double min_solid_angle) {
  return std::max(Improve::min_first_bound, Closing::margin * min_solid_angle);
}

/// Number of tets that follows from target lengths, or that the bounds on edge lengths allow.
std::size_t target_for_sizes(const Engine& engine, const SimplifyOptions& options) {
  double tets = static_cast<double>(options.target_tets);
  if (options.sizes)
    tets = tets_for_sizes(engine.mesh(), engine.sizes());
  else if (options.target_tets > 0)
    tets = std::max(std::min(tets, tets_for_edge(engine.mesh(), within_bounds * options.min_edge)),
                    tets_for_edge(engine.mesh(), options.max_edge / within_bounds));
  require_memory(Memory::program_bytes + Memory::bytes_per_tet * tets,
                 options.name + ": about " + short_number(tets) + " tets with edges of the target lengths",
                 "give larger ones");
  return options.target_tets == 0 && !options.sizes ? 0 : static_cast<std::size_t>(std::max(1.0, tets));
}

void check_options(const SimplifyOptions& options) {
  if (options.target_tets == 0 &&
      !((options.tolerance > 0 || options.sizes) && options.schedule == Schedule::tuned))
    throw UsageError("a target of 0 tets leaves nothing; give 1 or more");
  if (!(options.min_edge >= 0) || !(options.max_edge > options.min_edge))
    throw UsageError("the max edge must be above the min edge, and the min edge at least 0");
  if (!(options.tolerance >= 0)) throw UsageError("the tolerance must be at least 0");
  if (!(options.beta > 0) || !(options.gamma >= 0))
    throw UsageError("beta must be above 0 and gamma at least 0");
  if (options.original && options.surface)
    throw UsageError("give the original mesh or a surface to follow, not both");
}

/// False if the deadline of `progress` ended the work. Earlier changes are kept: a BlockRunner stops between
/// batches, when the mesh is consistent.
template <class Work>
bool done_in_time(const Work& work) {
  try {
    work();
  } catch (const OutOfTime&) {
    return false;
  }
  return true;
}

/// During its lifetime, moves the deadline forward to this fraction of the remaining time.
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

/// Result of simplify() in this case. The distance from the surface is still measured.
TetMesh not_simplified(TetMesh mesh, const SimplifyOptions& options, SimplifyReport* report,
                       const Progress* progress) {
  if (options.tolerance > 0 && report)
    report->deviation = options.surface ? deviation(mesh, *options.surface, progress) : DeviationReport();
  return unchanged(std::move(mesh), report);
}

bool is_bounded(const SimplifyOptions& options) {
  return options.sizes || options.min_edge > 0 || std::isfinite(options.max_edge);
}

/// The final improvement of the tuned schedule.
///
/// \param target number of tets; 0: the current one.
/// \param deviation receives the deviation of the result, if it is known.
void close(Engine& engine, const SimplifyOptions& options, std::size_t target, std::size_t first_count,
           const Progress* progress, std::optional<DeviationReport>& deviation) {
  const bool bounded = is_bounded(options);
  engine.begin_improvement();
  if (bounded) {
    WholeMesh whole(engine);
    adapt_edge_lengths(tools_of(engine), whole,
                       {.kind = "close",
                        .angle = Closing::margin * options.min_solid_angle,
                        .min_tets = 1,
                        .max_tets = std::numeric_limits<std::int64_t>::max()});
  }
  const auto near_target = [&](std::size_t tets) {
    return std::fabs(static_cast<double>(tets) - static_cast<double>(target)) <=
           Closing::slack * static_cast<double>(target);
  };
  const bool counted = target > 0 && !options.sizes && (!bounded || near_target(engine.mesh().live_tets()));
  const auto count = static_cast<double>(counted ? std::min(target, first_count) : engine.mesh().live_tets());
  // Without a target count, better shapes justify more tets and edges shorter than the target length.
  const double slack = counted ? Closing::slack : Closing::free_slack;
  if (options.sizes) engine.allow_shorter_edges();
  const ImprovementPlan plan{.kind = "close",
                             .angle = Closing::margin * options.min_solid_angle,
                             .leave_surface_angle = Closing::margin * options.min_solid_angle,
                             .target_tets = static_cast<std::size_t>(count),
                             .min_tets = static_cast<std::size_t>(std::ceil(count * (1 - slack))),
                             .max_tets = static_cast<std::size_t>(count * (1 + slack)),
                             .fast = false,
                             .brief = false,
                             .max_rounds = Closing::max_rounds};
  // Once a point has reached its feature edge, its neighbours may have more room.
  for (int i = 0; i < Features::closing_sweeps; ++i) fit_feature_edges(engine);
  fit(engine, Closing::sweeps_before, quality_at(engine, plan.angle));
  WholeMesh whole(engine);
  improve_area(tools_of(engine), whole, plan, 1);
  if (!counted) refine_bad_tets(tools_of(engine), whole, plan, options.min_solid_angle);
  // Improving shapes has worsened the fit.
  fit(engine, Closing::sweeps_after, quality_at(engine, plan.angle));
  // Fitting may push a tet below the bound.
  if (!counted) refine_bad_tets(tools_of(engine), whole, plan, options.min_solid_angle);
  if (options.tolerance == 0) return;
  deviation = engine.input_samples().deviation(progress);
  if (deviation->upper() <= options.tolerance) return;
  engine.throw_if_stopped();
  deviation.reset();
  // If the tolerance kept the count above the target in the loop, it may do so here.
  ImprovementPlan holding = plan;
  const auto live = static_cast<double>(engine.mesh().live_tets());
  if (live > static_cast<double>(plan.max_tets))
    holding.max_tets = static_cast<std::size_t>(live * (1 + Closing::free_slack));
  refine_beyond_tolerance(
      engine, whole, holding, options.min_solid_angle,
      options.tolerance * engine.mesh().space().scale() / (1 + relative_deviation_accuracy));
}

}  // namespace

TetMesh simplify(TetMesh mesh, const SimplifyOptions& options, SimplifyReport* report, Progress* progress) {
  check_options(options);
  check_mesh(mesh, options.frozen, options.name);
  if (out_of_time(progress)) return not_simplified(std::move(mesh), options, report, progress);
  const bool tuned = options.schedule == Schedule::tuned;
  const auto start = std::chrono::steady_clock::now();
  const LoopTimes loops_before = loop_times();
  const std::size_t first_count = mesh.tets.size();
  Engine engine(
      std::move(mesh),
      {options.name, static_cast<double>(options.target_tets > 0 ? options.target_tets : first_count),
       options.beta, options.gamma, options.seed, options.batch_size, options.objective, options.reference,
       options.frozen, options.fix_boundary, tuned, options.original},
      report, progress);
  std::size_t target = options.target_tets;
  if (is_bounded(options) && tuned) {
    engine.set_sizes(options.sizes, options.min_edge, options.max_edge);
    target = target_for_sizes(engine, options);
    if (target != options.target_tets)
      engine.rules.objective.quality =
          TetQuality::for_target(engine.mesh().total_volume(), static_cast<double>(target), options.beta);
  }
  // Each step may take a large part of the time if the mesh is large for the time limit.
  const bool built = done_in_time([&] {
    engine.throw_if_stopped();
    if (!tuned) return;
    engine.keep_surface(options.surface, options.tolerance > 0);
    engine.throw_if_stopped();
    // If time ends within this, the mesh is unchanged. After it, time is asked for in the loop only.
    if (!is_bounded(options) && options.tolerance == 0 && !options.original)
      merge_in_bulk(engine, static_cast<double>(options.target_tets), options.seed);
    engine.compact();
  });
  const double build = seconds_since(start);
  const LoopTimes loops_build = loop_times();
  if (report) {
    report->seconds_build = build;
    report->loops_build = loops_build - loops_before;
  }
  if (!built) return not_simplified(std::move(engine).take(), options, report, progress);
  std::optional<DeviationReport> deviation;
  bool in_time = true;
  double loop_end = build;
  LoopTimes loops_loop_end = loops_build;
  {
    const EarlierDeadline measuring_has_time(progress, options.tolerance > 0 ? TimeLimit::changing_share : 1);
    in_time = done_in_time([&] {
      const EarlierDeadline closing_has_time(progress, tuned ? TimeLimit::loop_share : 1);
      engine.recorder().begin_stage("simplify");
      if (tuned && options.original) even_out_parts(engine, target, options.max_iterations);
      if (tuned)
        run_tuned_schedule(engine, options, target);
      else
        run_paper_schedule(engine, options);
    });
    loop_end = seconds_since(start);
    loops_loop_end = loop_times();
    if (tuned) {
      // If the deadline prevented the target, the final improvement keeps the current count.
      const std::size_t closing_target = in_time ? target : engine.mesh().live_tets();
      in_time &= done_in_time([&] {
        engine.recorder().begin_stage("improve");
        close(engine, options, closing_target, first_count, progress, deviation);
      });
    }
  }
  if (options.tolerance > 0 && !deviation) {
    engine.recorder().begin_stage("compare");
    deviation = engine.input_samples().deviation(progress);
  }
  if (report) {
    report->deviation = deviation;
    report->out_of_time = !in_time;
    report->touching_points = engine.mesh().touching_points();
    report->seconds_simplify = loop_end - build;
    report->seconds_close = seconds_since(start) - loop_end;
    report->loops_simplify = loops_loop_end - loops_build;
    report->loops_close = loop_times() - loops_loop_end;
  }
  return std::move(engine).take();
}

DeviationReport deviation(const TetMesh& mesh, const TriangleMesh& surface, const Progress* progress) {
  const EditableMesh editable(TetMesh(mesh), "mesh");
  RepresentedSurface input(editable, &surface);
  input.find_hidden(editable);
  return input.deviation(editable, progress);
}

namespace {

/// improve() with `only_below`: a Remesher works only on the regions of bad tets.
TetMesh improve_bad_regions(TetMesh&& mesh, const ImproveOptions& options, std::size_t min_tets,
                            std::size_t max_tets, SimplifyReport* report, Progress* progress) {
  const auto start = std::chrono::steady_clock::now();
  const LoopTimes loops_before = loop_times();
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
  const LoopTimes loops_build = loop_times();
  int rounds = options.max_iterations;
  const auto improve_up_to = [&](double angle) {
    const double bound = shape_quality_bound(options.objective, angle);
    // Each bound gets half of the remaining rounds, the last one all.
    const int kept = angle < options.only_below ? rounds / 2 : 0;
    for (double min_bad = std::numeric_limits<double>::infinity(); rounds > kept;) {
      std::vector<Index> bad;
      for (Index t = 0; t < remesher.tet_slots(); ++t)
        if (remesher.has_tet(t) && remesher.quality(t) <= bound) bad.push_back(t);
      if (bad.empty() || static_cast<double>(bad.size()) > Improve::min_call_gain * min_bad) break;
      min_bad = static_cast<double>(bad.size());
      const RemeshChanges changes =
          remesher.improve(RemeshRegion::tets(std::move(bad)),
                           {.angle = angle,
                            .leave_surface_angle = Improve::margin * options.min_solid_angle,
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
    report->loops_build = loops_build - loops_before;
    report->loops_close = loop_times() - loops_build;
  }
  return std::move(remesher).mesh();
}

}  // namespace

TetMesh improve(TetMesh mesh, const ImproveOptions& options, SimplifyReport* report, Progress* progress) {
  check_mesh(mesh, options.frozen, options.name);
  if (out_of_time(progress)) return unchanged(std::move(mesh), report);
  const auto start = std::chrono::steady_clock::now();
  const LoopTimes loops_before = loop_times();
  const auto count = static_cast<double>(mesh.tets.size());
  const auto min_tets = static_cast<std::size_t>(
      std::ceil(count * (options.free_count ? Improve::min_free : 1 - Improve::slack)));
  const auto max_tets =
      static_cast<std::size_t>(count * (options.free_count ? Improve::max_free : 1 + Improve::slack));
  if (options.only_below > 0)
    return improve_bad_regions(std::move(mesh), options, min_tets, max_tets, report, progress);
  const SimplifyOptions defaults;
  Engine engine(std::move(mesh),
                {options.name, count, defaults.beta, defaults.gamma, options.seed, options.batch_size,
                 options.objective, options.reference, options.frozen, options.fix_boundary},
                report, progress);
  engine.recorder().begin_stage("improve");
  const double build = seconds_since(start);
  const LoopTimes loops_build = loop_times();
  engine.rules.error.max = Improve::error_edges * engine.rules.objective.quality.ideal_edge;
  const double below = Improve::margin * options.min_solid_angle;
  // Reserve the last rounds for the end.
  const int kept_rounds = std::min(options.max_iterations / 2, Improve::max_last_rounds);
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
      plan.max_rounds -= improve_area(tools, whole, plan, Improve::bulk_before);
      if (plan.max_rounds <= 0) break;
    }
    plan.max_rounds += kept_rounds;
    if (plan.max_rounds <= 0) return;
    plan.max_rounds -=
        run_bulk_improvement(tools, whole,
                             {.kind = plan.kind,
                              .bad_quality = quality_at(engine, std::max(below, Improve::polish_below)),
                              .min_tets = plan.min_tets,
                              .max_tets = plan.max_tets,
                              .max_rounds = std::min(plan.max_rounds, Improve::max_polish_rounds),
                              .remodel = false});
    // With the connectivity changed around the last bad tets, they may improve further.
    if (plan.max_rounds > 0) plan.max_rounds -= run_improvement(tools, whole, plan);
    if (!options.free_count || whole.bad_tets(quality_at(engine, options.min_solid_angle)).empty()) return;
    // The last bad tets are often stuck where the count does not allow further collapses.
    plan.min_tets = static_cast<std::size_t>(std::ceil(count * Improve::min_free_of_bad));
    if (plan.max_rounds > 0) improve_area(tools, whole, plan, Improve::bulk_before);
  });
  if (report) {
    report->out_of_time = !in_time;
    report->touching_points = engine.mesh().touching_points();
    report->seconds_build = build;
    report->seconds_close = seconds_since(start) - build;
    report->loops_build = loops_build - loops_before;
    report->loops_close = loop_times() - loops_build;
  }
  return std::move(engine).take();
}

}  // namespace tetwright

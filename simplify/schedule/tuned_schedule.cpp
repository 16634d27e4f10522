// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/tuned_schedule.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/portable_math.h"
#include "common/tolerances.h"
#include "simplify/operations/collapse.h"
#include "simplify/operations/edge_removal.h"
#include "simplify/operations/face_removal.h"
#include "simplify/operations/smoothing.h"
#include "simplify/schedule/fitting_sweeps.h"
#include "simplify/schedule/selection.h"
#include "simplify/tuning/coarsening_tuning.h"
#include "simplify/tuning/merging_tuning.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using Closing = SimplifyTuning::Closing;
using Coarsening = CoarseningTuning;
using Merging = MergingTuning;
using Schedules = SimplifyTuning::Schedules;
using Tolerance = SimplifyTuning::Tolerance;
using TunedLoop = SimplifyTuning::TunedLoop;

void collapse_block(Engine& engine, float limit, std::size_t target) {
  EditableMesh& mesh = engine.mesh();
  engine.runner().each_star(
      bad_points(mesh, limit), Operation::collapse, [&](Workspace& ws) { return collapse(ws, engine.rules); },
      [&] { return mesh.live_tets() <= target; });
}

/// Flips and smooths tets that are still bad.
void flip_and_smooth_block(Engine& engine, float limit) {
  const EditableMesh& mesh = engine.mesh();
  engine.runner().tets(
      bad_tets(mesh, limit),
      [&](Workspace& ws, const TetSnapshot& item, int) {
        // A neighbour's operation may have improved the tet since it was listed.
        if (!exists(mesh, item) || mesh.quality(item.tet) > limit) return Outcome::stale;
        for (int f = 0; f < 4; ++f)
          if (remove_face(ws, engine.rules, item.tet, f, basic_reach) == Outcome::done) return Outcome::done;
        for (int e = 0; e < 6; ++e)
          if (remove_edge(ws, engine.rules, item.tet, e, basic_reach) == Outcome::done) return Outcome::done;
        for (Index p : item.points) {
          Outcome o = ws.gather(p);
          if (o == Outcome::done) o = smooth(ws, engine.rules);
          if (ws.count(Operation::smooth, o) == Outcome::done) return o;
        }
        return Outcome::no_candidate;
      },
      [] { return false; });
}

/// Sets the rules with which a loop begins.
void begin_loop(BlockRules& rules) {
  rules.objective.kind = Objective::Kind::paper;
  rules.objective.quality.needle_angle = TunedLoop::needle_angle;
  rules.error.max = TunedLoop::first_error_edges * rules.objective.quality.ideal_edge;
  rules.acceptance.worse_floor = TunedLoop::annealing_floor;
  rules.collapse.distance_weight = TunedLoop::distance_weight;
}

/// Logarithm of the ratio of a mesh's tets to the target, which must be above 0 even at the target.
double log_ratio(double tets, double target) {
  return portable_log(std::max(tets / target, 1 + tolerance::at_target));
}

/// Runs the block iteration down to a target.
///
/// \param counted whether the target is the final one, not an intermediate stage towards as few tets as the
///   tolerance allows.
/// \return whether the target was reached.
bool simplify_to(Engine& engine, const SimplifyOptions& options, std::size_t loop_target,
                 bool counted = true) {
  EditableMesh& mesh = engine.mesh();
  BlockRules& rules = engine.rules;
  const auto target = static_cast<double>(loop_target);
  // Merging points has done the first part of the loop.
  const auto first_tets = static_cast<double>(counted ? engine.first_tets() : mesh.live_tets());
  const double log_first = log_ratio(first_tets, target);
  const double max_error = Schedules::max_useful_error * std::max(1.0, options.gamma / 10);
  begin_loop(rules);
  double& error = *rules.error.max;
  // Rounded up, since for small targets the slack is less than one tet.
  rules.count.min = static_cast<std::size_t>(std::ceil(target * (1 - Closing::slack)));
  engine.rate_all();
  double percent = Schedules::percent_step;
  int idle = 0;
  for (int i = 0; i < options.max_iterations && mesh.live_tets() > loop_target; ++i) {
    if (!engine.input_samples().assigned() &&
        (static_cast<double>(mesh.live_tets()) < TunedLoop::samples_below * target ||
         engine.ledger().utilization() > TunedLoop::fit_above_utilization)) {
      engine.assign_samples(rules.objective.quality.ideal_edge);
      rules.deviation.max = TunedLoop::first_deviation * rules.objective.quality.ideal_edge;
    } else {
      engine.compact_if_sparse();
    }
    RoundRecorder::Round round(engine.recorder(), "simplify", error);
    IterationReport& it = round.report();
    it.percent = percent;
    it.tets_by_quality = tets_by_quality(mesh);
    rules.count.max = it.tets_before;
    const double log_now = portable_log(static_cast<double>(it.tets_before) / target);
    rules.acceptance.worse_probability =
        Schedules::first_annealing * std::clamp(log_now / log_first, 0.0, 1.0);
    if (!counted && share_below(mesh, rules.objective, options.min_solid_angle) > Tolerance::max_bad_share)
      rules.acceptance.worse_probability = 0;
    const float limit = quality_cutoff(mesh, percent);
    it.cutoff = portable_cbrt(limit);
    fit_feature_edges(engine);
    collapse_block(engine, limit, loop_target);
    const std::size_t collapsed = mesh.live_tets();
    const double removed = 1 - static_cast<double>(collapsed) / static_cast<double>(it.tets_before);
    // If collapses stall, changes of connectivity and positions may allow more. Far from the target, larger
    // bounds allow as much in less time.
    const bool stalled = removed < TunedLoop::min_removed && percent >= 100;
    if (collapsed > loop_target && (static_cast<double>(collapsed) < TunedLoop::flips_below * target ||
                                    (stalled && removed < TunedLoop::bounds_remove)))
      flip_and_smooth_block(engine,
                            stalled ? limit : std::min(limit, quality_cutoff(mesh, TunedLoop::flip_percent)));
    // If a body has lost much of its volume, fit its surface back to the middle of its samples; near the
    // target fit every surface.
    const bool near_target = static_cast<double>(collapsed) < TunedLoop::fits_below * target;
    if (collapsed > loop_target &&
        (near_target || engine.ledger().utilization() > TunedLoop::fit_above_utilization))
      fit_interfaces(engine, 1, near_target ? -1 : TunedLoop::fit_above_utilization);
    round.finish();
    // A larger E helps only if E causes the refusals.
    const bool error_refuses =
        error < max_error &&
        TunedLoop::error_refusals_inverse * it.counts.of(Operation::collapse, Outcome::surface_error) >
            it.counts.tried(Operation::collapse);
    if (removed < TunedLoop::min_removed) {
      error = std::min(max_error, TunedLoop::error_growth * error);
      rules.deviation.max = rules.deviation.widened(TunedLoop::deviation_growth);
    }
    const bool sized = rules.sizes && rules.sizes->has_target_length();
    if (removed < (sized     ? Tolerance::sized_min_removed
                   : counted ? 0
                             : Tolerance::stage_min_removed) &&
        percent >= 100)
      break;
    idle = removed < Schedules::idle_below && percent >= 100 && !error_refuses ? idle + 1 : 0;
    if (idle == Schedules::max_idle_iterations) break;
    percent = std::min(100.0, percent + Schedules::percent_step);
    engine.recorder().update(1 - log_now / log_first);
  }
  rules.acceptance.worse_probability = 0;
  return mesh.live_tets() <= loop_target;
}

}  // namespace

void merge_in_bulk(Engine& engine, double target, std::uint64_t seed) {
  if (!(static_cast<double>(engine.mesh().live_tets()) >= Merging::min_ratio * target)) return;
  const double edge = engine.rules.objective.quality.ideal_edge;
  engine.merge_points({.max_distance = Merging::max_distance_edges * edge,
                       .max_deviation = Merging::max_deviation_edges * edge,
                       .seed = seed});
}

void run_collapses(Engine& engine, double final_target, std::size_t loop_target, int max_iterations) {
  const EditableMesh& mesh = engine.mesh();
  BlockRules& rules = engine.rules;
  begin_loop(rules);
  rules.count.min = loop_target;
  engine.rate_all();
  const double log_first = log_ratio(static_cast<double>(engine.first_tets()), final_target);
  double percent = Schedules::percent_step;
  for (int i = 0; i < max_iterations && mesh.live_tets() > loop_target; ++i) {
    engine.compact_if_sparse();
    RoundRecorder::Round round(engine.recorder(), "coarsen", *rules.error.max);
    IterationReport& it = round.report();
    it.percent = percent;
    it.tets_by_quality = tets_by_quality(mesh);
    const auto before = static_cast<double>(it.tets_before);
    const double log_now = log_ratio(before, final_target);
    rules.acceptance.worse_probability =
        Schedules::first_annealing * std::clamp(log_now / log_first, 0.0, 1.0);
    const float limit = quality_cutoff(mesh, percent);
    it.cutoff = portable_cbrt(limit);
    collapse_block(engine, limit, loop_target);
    round.finish();
    const double removed = 1 - static_cast<double>(mesh.live_tets()) / before;
    if (removed < TunedLoop::min_removed && percent >= 100) break;
    percent = std::min(100.0, percent + Schedules::percent_step);
  }
  rules.acceptance.worse_probability = 0;
}

void even_out_parts(Engine& engine, std::size_t target, int max_iterations) {
  const EditableMesh& mesh = engine.mesh();
  BlockRules& rules = engine.rules;
  begin_loop(rules);
  rules.count.min = target;
  rules.acceptance.worse_probability = Schedules::first_annealing;
  engine.rate_all();
  double removed = 1;
  for (int i = 0; i < max_iterations && removed >= Coarsening::evened_out; ++i) {
    engine.compact_if_sparse();
    RoundRecorder::Round round(engine.recorder(), "simplify", *rules.error.max);
    const auto before = static_cast<double>(mesh.live_tets());
    round.report().cutoff = portable_cbrt(Coarsening::cut_quality);
    collapse_block(engine, Coarsening::cut_quality, target);
    round.finish();
    removed = 1 - static_cast<double>(mesh.live_tets()) / before;
  }
  rules.acceptance.worse_probability = 0;
}

void run_tuned_schedule(Engine& engine, const SimplifyOptions& options, std::size_t loop_target) {
  EditableMesh& mesh = engine.mesh();
  BlockRules& rules = engine.rules;
  if (options.tolerance > 0) {
    const double loop_tolerance =
        Tolerance::loop_share *
        std::min(options.tolerance * mesh.space().scale(), Tolerance::max_diagonal_share * mesh.diagonal());
    rules.deviation = {.max = loop_tolerance, .tolerance = loop_tolerance};
    std::optional<double>& feature_distance = rules.surface.max_feature_distance;
    if (feature_distance) feature_distance = std::min(*feature_distance, loop_tolerance);
    engine.input_samples().set_spacing(Tolerance::between_places * loop_tolerance);
    const double edge = Tolerance::to_edge * loop_tolerance;
    engine.assign_samples(loop_target > 0 ? std::min(rules.objective.quality.ideal_edge, edge) : edge);
  }
  if (loop_target > 0) {
    simplify_to(engine, options, loop_target);
  } else {
    // As few tets as the tolerance allows: run towards successive targets, each of which sets the ideal tet
    // size.
    bool reached = true;
    while (reached && mesh.live_tets() > 1) {
      const double target =
          std::max(1.0, std::floor(Tolerance::stage_share * static_cast<double>(mesh.live_tets())));
      rules.objective.quality = TetQuality::for_target(mesh.total_volume(), target, options.beta);
      reached = simplify_to(engine, options, static_cast<std::size_t>(target), false);
    }
  }
  if (options.tolerance > 0) {
    const double room = Tolerance::closing_share / Tolerance::loop_share;
    *rules.deviation.tolerance *= room;
    *rules.deviation.max *= room;
  }
}

}  // namespace tetwright

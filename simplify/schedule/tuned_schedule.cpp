// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/tuned_schedule.h"

#include <algorithm>
#include <cmath>

#include "common/portable_math.h"
#include "common/tolerances.h"
#include "simplify/operations/collapse.h"
#include "simplify/operations/edge_removal.h"
#include "simplify/operations/face_removal.h"
#include "simplify/operations/smoothing.h"
#include "simplify/schedule/schedule_constants.h"

namespace tetwright {

namespace {

// Tuned on scans (README.md, The tuned schedule).
constexpr double first_error_edges = 4;  ///< initial E, in ideal edges
constexpr double error_growth = 1.3;     ///< E's factor after an iteration that removed too little
constexpr double min_removed = 0.15;     ///< share of the tets: removing less is too little
constexpr double flip_percent = 40;      ///< max percentage of tets that flips and smoothing work on
constexpr double swaps_below = 2;        ///< times the target: above it flips and smoothing are wasted
/// Share of the worst Quality^3 that annealing must leave. Below this value (0: anything positive) the loop
/// ends with 5-10 % of tets under 0.1 sr instead of 2-3 %; larger values need a larger E to reach the target,
/// which costs surface and volume.
constexpr float annealing_floor = 0.1f;
/// TetQuality::needle_angle, steradians: without it thin layers of tiny tets end as needles with hardly any
/// angle.
constexpr double needle_angle = 0.02;
/// E over the max distance by which a collapse may move the surface at the removed point. On five scans
/// (10,000 tets) the max distance ended at 1.3-2.2 % of the diagonal without it, at 1.0-1.7 % with it; larger
/// values drive E up instead.
constexpr double distance_weight = 50;
/// Multiple of the target below which triangles own samples of the input's surface: until then E keeps
/// surfaces near enough, and samples from the start would take twice the time for nothing.
constexpr double samples_below = 8;
/// Initial BlockRules::max_deviation, in ideal edges, and its factor after an iteration that removed too
/// little. Bunny and armadillo to 10K, mean of the max distances both ways in percent of the diagonal: 0.38
/// with these values, 0.43 with 0.2 and 1.1, 0.33 with 0.18 and 1.05, which takes longer and leaves less room
/// for shapes.
constexpr double first_deviation = 0.2;
constexpr double deviation_growth = 1.05;
/// Share of SimplifyOptions::tolerance that samples may be off in the loop, and in the closing, which needs
/// room for shapes: between samples surfaces may be farther, on scans by up to 15 %.
constexpr double loop_tolerance = 0.8, closing_tolerance = 0.87;
/// Max tolerance, as a share of the diagonal: larger ones bound nothing, and their samples would be too few
/// to fit to.
constexpr double max_tolerance = 0.1;
/// With a tolerance: max edge, in sampled tolerances, whose triangles set the density of samples, and
/// distance between the tested points of triangles. With 4 and 1 the bunny at 0.5 % is up to 4.6 % farther
/// between them, with these values 1 %.
constexpr double tolerances_to_edge = 2.5, tolerances_between_places = 0.5;
/// Without a count: ratio of successive targets, and the share of the tets below which an iteration over all
/// of them ends a stage. The last value is for target lengths: rounds of edge length adaptation do the rest.
constexpr double stage_share = 0.6, stage_min_removed = 0.1, sized_min_removed = 0.01;
/// Share of bad tets above which annealing accepts no worse ones, without a count: only the tolerance ends
/// that loop, and on the way to where it refuses everything, the bunny at 0.2 % had 41 % of bad tets, for
/// 23 % fewer tets.
constexpr double max_bad_share = 0.25;
/// Multiple of the target below which every iteration fits surfaces: fitting from 4 times the target on makes
/// the result no better, no fitting in the loop makes it 10 % worse.
constexpr double fits_below = 2;
/// VolumeLedger::utilization() above which the loop fits surfaces.
constexpr double fit_above_utilization = 0.6;

void collapse_block(Engine& engine, float limit, std::size_t target) {
  EditableMesh& mesh = engine.mesh();
  engine.runner().each_star(
      engine.bad_points(limit), Operation::collapse,
      [&](Workspace& ws) { return collapse(ws, engine.rules); }, [&] { return mesh.live_tets() <= target; });
}

/// Flips and smooths tets that are still bad.
void flip_and_smooth_block(Engine& engine, float limit) {
  const EditableMesh& mesh = engine.mesh();
  engine.runner().tets(
      engine.bad_tets(limit),
      [&](Workspace& ws, const TetSnapshot& item, int) {
        // The tet may have been improved by a neighbour's operation since it was listed.
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

/// Runs the loop down to a target.
///
/// \param counted the target is the one asked for, not a stage on the way to as few tets as the tolerance
///   allows.
/// \return whether the target was reached.
bool simplify_to(Engine& engine, const SimplifyOptions& options, std::size_t loop_target,
                 bool counted = true) {
  EditableMesh& mesh = engine.mesh();
  BlockRules& rules = engine.rules;
  const auto target = static_cast<double>(loop_target);
  const double log_first =
      portable_log(std::max(static_cast<double>(mesh.live_tets()) / target, 1 + tolerance::at_target));
  const double max_error = max_useful_error * std::max(1.0, options.gamma / 10);
  rules.objective.kind = Objective::Kind::paper;
  rules.objective.quality.needle_angle = needle_angle;
  rules.max_error = first_error_edges * rules.objective.quality.ideal_edge;
  rules.annealing_floor = annealing_floor;
  rules.distance_weight = distance_weight;
  // Rounded up: for small targets the slack is less than one tet.
  rules.count.min = static_cast<std::size_t>(std::ceil(target * (1 - closing_slack)));
  engine.rate_all();
  double percent = percent_step;
  int idle = 0;
  for (int i = 0; i < options.max_iterations && mesh.live_tets() > loop_target; ++i) {
    if (!engine.owns_samples() && (static_cast<double>(mesh.live_tets()) < samples_below * target ||
                                   engine.ledger().utilization() > fit_above_utilization)) {
      engine.own_samples(rules.objective.quality.ideal_edge);
      rules.max_deviation = first_deviation * rules.objective.quality.ideal_edge;
    } else {
      engine.compact_if_sparse();
    }
    RoundRecorder::Round round(engine.recorder(), "simplify", rules.max_error);
    IterationReport& it = round.report();
    it.percent = percent;
    rules.count.max = it.tets_before;
    const double log_now = portable_log(static_cast<double>(it.tets_before) / target);
    rules.accept_worse = first_annealing * std::clamp(log_now / log_first, 0.0, 1.0);
    if (!counted && engine.share_below(options.min_solid_angle) > max_bad_share) rules.accept_worse = 0;
    const float limit = engine.cutoff(percent);
    it.cutoff = portable_cbrt(limit);
    engine.fit_creases();
    collapse_block(engine, limit, loop_target);
    const std::size_t collapsed = mesh.live_tets();
    const double removed = 1 - static_cast<double>(collapsed) / static_cast<double>(it.tets_before);
    // If collapses stall, other connectivity and positions may let them continue.
    if (collapsed > loop_target &&
        (static_cast<double>(collapsed) < swaps_below * target || (removed < min_removed && percent >= 100)))
      flip_and_smooth_block(engine, removed < min_removed && percent >= 100
                                        ? limit
                                        : std::min(limit, engine.cutoff(flip_percent)));
    // If a body has lost much of its volume, fit its surface back to the middle of its samples; near the
    // target fit every surface.
    if (collapsed > loop_target && (engine.ledger().utilization() > fit_above_utilization ||
                                    static_cast<double>(collapsed) < fits_below * target))
      engine.fit_interfaces(1);
    round.finish();
    // A larger E helps only if E is what refuses.
    const bool error_refuses =
        rules.max_error < max_error &&
        10 * it.counts.of(Operation::collapse, Outcome::surface_error) > it.counts.tried(Operation::collapse);
    if (removed < min_removed) {
      rules.max_error = std::min(max_error, error_growth * rules.max_error);
      rules.max_deviation = std::min(rules.tolerance, deviation_growth * rules.max_deviation);
    }
    const bool sized = rules.sizes && rules.sizes->has_target_length();
    if (removed < (sized ? sized_min_removed : counted ? 0 : stage_min_removed) && percent >= 100) break;
    idle = removed < idle_below && percent >= 100 && !error_refuses ? idle + 1 : 0;
    if (idle == max_idle_iterations) break;
    percent = std::min(100.0, percent + percent_step);
    engine.recorder().update(1 - log_now / log_first);
  }
  rules.accept_worse = 0;
  return mesh.live_tets() <= loop_target;
}

}  // namespace

void run_tuned_schedule(Engine& engine, const SimplifyOptions& options, std::size_t loop_target) {
  EditableMesh& mesh = engine.mesh();
  BlockRules& rules = engine.rules;
  if (options.tolerance > 0) {
    rules.tolerance = rules.max_deviation =
        loop_tolerance * std::min(options.tolerance * mesh.space().scale(), max_tolerance * mesh.diagonal());
    rules.max_crease_distance = std::min(rules.max_crease_distance, rules.tolerance);
    engine.set_spacing(tolerances_between_places * rules.tolerance);
    const double edge = tolerances_to_edge * rules.tolerance;
    engine.own_samples(loop_target > 0 ? std::min(rules.objective.quality.ideal_edge, edge) : edge);
  }
  if (loop_target > 0) {
    simplify_to(engine, options, loop_target);
  } else {
    // As few as the tolerance allows: tet sizes follow one target after the other.
    bool reached = true;
    while (reached && mesh.live_tets() > 1) {
      const double target = std::max(1.0, std::floor(stage_share * static_cast<double>(mesh.live_tets())));
      rules.objective.quality = TetQuality::for_target(mesh.total_volume(), target, options.beta);
      reached = simplify_to(engine, options, static_cast<std::size_t>(target), false);
    }
  }
  if (options.tolerance > 0) {
    const double room = closing_tolerance / loop_tolerance;
    rules.tolerance *= room;
    rules.max_deviation *= room;
  }
}

}  // namespace tetwright

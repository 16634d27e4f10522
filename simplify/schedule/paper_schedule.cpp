// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/paper_schedule.h"

#include <algorithm>
#include <cmath>

#include "common/portable_math.h"
#include "common/tolerances.h"
#include "simplify/operations/collapse.h"
#include "simplify/operations/collapse_table.h"
#include "simplify/operations/edge_removal.h"
#include "simplify/operations/face_removal.h"
#include "simplify/operations/insertion.h"
#include "simplify/operations/smoothing.h"
#include "simplify/schedule/selection.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using PaperSchedule = SimplifyTuning::PaperSchedule;
using Schedules = SimplifyTuning::Schedules;

/// Collapses the tet's half-edge of least weight that passes every test.
Outcome collapse_tet(Workspace& ws, const BlockRules& rules, const TetSnapshot& item) {
  struct HalfEdge {
    double weight;
    Index from, to;
  };
  std::array<HalfEdge, 12> edges;
  std::size_t count = 0;
  Outcome refusal = Outcome::material_rule;
  for (Index from : item.points) {
    Star& star = ws.star;
    if (const Outcome o = ws.gather(from); o != Outcome::done) return o;
    const int along = collapsible_edge(vertex_kind(star));
    if (along == never) continue;
    star.compute_gradients();
    for (std::size_t p = 0; p < star.points.size(); ++p) {
      if (std::find(item.points.begin(), item.points.end(), star.points[p]) == item.points.end()) continue;
      if (star.edge_dimension(p) != along) continue;
      const double weight = collapse_weight(star, p, rules);
      if (weight <= rules.error.limit()) {
        edges[count++] = {weight, from, star.points[p]};
      } else {
        refusal = Outcome::surface_error;
      }
    }
  }
  std::sort(edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(count),
            [](const HalfEdge& a, const HalfEdge& b) {
              return a.weight != b.weight ? a.weight < b.weight
                                          : std::array{a.from, a.to} < std::array{b.from, b.to};
            });
  for (std::size_t i = 0; i < count; ++i) {
    Star& star = ws.star;
    if (const Outcome o = ws.gather(edges[i].from); o != Outcome::done) return o;
    const auto b = std::find(star.points.begin(), star.points.end(), edges[i].to) - star.points.begin();
    refusal = collapse_onto(ws, rules, static_cast<std::size_t>(b));
    if (refusal == Outcome::done) break;
  }
  return refusal;
}

/// "move each vertex of the element": moves the first point from `first` on that can move; the turn continues
/// with the next.
Outcome smooth_points(Workspace& ws, const BlockRules& rules, const TetSnapshot& item, int first) {
  for (int k = first; k < 4; ++k) {
    Outcome o = ws.gather(item.points[k]);
    if (o == Outcome::done) o = smooth(ws, rules);
    if (ws.count(Operation::smooth, o) != Outcome::done) continue;
    ws.proposal.next_stage = k + 1 < 4 ? k + 1 : -1;
    return o;
  }
  return Outcome::no_candidate;
}

/// One step at a tet: tries the actions of section 4 in their order until one succeeds. A stage above 0 is
/// the next point to move.
Outcome paper_step(Workspace& ws, const BlockRules& rules, const TetSnapshot& item, int stage, float limit) {
  const EditableMesh& mesh = ws.mesh;
  if (!exists(mesh, item)) return Outcome::stale;
  if (stage > 0) return smooth_points(ws, rules, item, stage);
  if (mesh.quality(item.tet) > limit) return Outcome::stale;
  for (int f = 0; f < 4; ++f)
    if (remove_face(ws, rules, item.tet, f, basic_reach) == Outcome::done) return Outcome::done;
  for (int e = 0; e < 6; ++e)
    if (remove_edge(ws, rules, item.tet, e, basic_reach) == Outcome::done) return Outcome::done;
  if (ws.count(Operation::collapse, collapse_tet(ws, rules, item)) == Outcome::done) return Outcome::done;
  if (smooth_points(ws, rules, item, 0) == Outcome::done) return Outcome::done;
  // A new point must improve the tets around it. With annealing, tets would be split indefinitely.
  BlockRules strict = rules;
  strict.acceptance.worse_probability = 0;
  if (insert_in_tet(ws, strict, item.tet, InsertionPlace::centre) == Outcome::done) return Outcome::done;
  for (int f = 0; f < 4; ++f)
    if (insert_in_face(ws, strict, item.tet, f, InsertionPlace::centre) == Outcome::done)
      return Outcome::done;
  for (int e = 0; e < 6; ++e)
    if (insert_in_edge(ws, strict, item.tet, e, InsertionPlace::centre, false) == Outcome::done)
      return Outcome::done;
  return Outcome::no_candidate;
}

std::size_t below_angle(const EditableMesh& mesh, double angle) {
  std::size_t count = 0;
  for (Index t = 0; t < mesh.tet_slots(); ++t) {
    const Tet& p = mesh.points(t);
    if (p[0] == no_index) continue;
    count += min_solid_angle(mesh.position(p[0]), mesh.position(p[1]), mesh.position(p[2]),
                             mesh.position(p[3])) < angle;
  }
  return count;
}

}  // namespace

void run_paper_schedule(Engine& engine, const SimplifyOptions& options) {
  EditableMesh& mesh = engine.mesh();
  BlockRules& rules = engine.rules;
  const std::size_t target_tets = std::min(options.target_tets, mesh.live_tets());
  const auto target = static_cast<double>(target_tets);
  const double log_first =
      portable_log(std::max(static_cast<double>(mesh.live_tets()) / target, 1 + tolerance::at_target));
  const double max_interpolation_error = Schedules::max_useful_error * std::max(1.0, options.gamma / 10);
  rules.objective.kind = Objective::Kind::paper;
  double& error = rules.error.max.emplace(rules.objective.quality.ideal_edge);
  rules.acceptance.worse_floor = 0;
  rules.error.losses_cancel = true;
  rules.count.min = static_cast<std::size_t>(std::ceil(target * (1 - PaperSchedule::count_slack)));
  engine.compact();
  engine.rate_all();
  double percent = Schedules::percent_step;
  int idle = 0;
  bool reached = false;
  std::size_t bad = mesh.live_tets();
  for (int i = 0; i < options.max_iterations && idle < Schedules::max_idle_iterations; ++i) {
    reached = reached || mesh.live_tets() <= target_tets;
    if (reached) {
      // Second stopping criterion: the number of bad tets shows whether there is still gain.
      const std::size_t now = below_angle(mesh, options.min_solid_angle);
      if (now == 0) break;
      idle = now < bad ? 0 : idle + 1;
      bad = now;
    }
    engine.compact_if_sparse();
    RoundRecorder::Round round(engine.recorder(), "simplify", error);
    IterationReport& it = round.report();
    it.percent = percent;
    it.tets_by_quality = tets_by_quality(mesh);
    const auto before = static_cast<double>(it.tets_before);
    const double log_now = portable_log(std::max(before / target, 1.0));
    rules.acceptance.worse_probability =
        reached ? 0 : Schedules::first_annealing * std::clamp(log_now / log_first, 0.0, 1.0);
    // Before the target is reached, allow any count that does not undo earlier iterations; afterwards only
    // changes that keep or restore the target count.
    rules.count.max =
        reached ? static_cast<std::size_t>(target * (1 + PaperSchedule::count_slack)) : it.tets_before;
    const float limit = quality_cutoff(mesh, percent);
    it.cutoff = portable_cbrt(limit);
    engine.runner().tets(
        bad_tets(mesh, limit),
        [&](Workspace& ws, const TetSnapshot& item, int stage) {
          return paper_step(ws, rules, item, stage, limit);
        },
        [&] { return !reached && mesh.live_tets() <= target_tets; });
    round.finish();
    if (!reached) {
      const auto after = static_cast<double>(mesh.live_tets());
      const bool error_grows = error < max_interpolation_error;
      if (percent >= 100 && !error_grows) idle = 1 - after / before < Schedules::idle_below ? idle + 1 : 0;
      error = std::min(max_interpolation_error, error * std::max(1.0, portable_cbrt(after / target)));
    }
    percent = std::min(100.0, percent + Schedules::percent_step);
    engine.recorder().update(1 - log_now / log_first);
  }
  rules.acceptance.worse_probability = 0;
}

}  // namespace tetwright

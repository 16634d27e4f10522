// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/improve_step.h"

#include <algorithm>

#include "simplify/operations/collapse.h"
#include "simplify/operations/edge_removal.h"
#include "simplify/operations/face_removal.h"
#include "simplify/operations/insertion.h"
#include "simplify/operations/smoothing.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using Collapses = SimplifyTuning::Collapses;

/// Smooths the tet's points until one move improves the worst tet around.
Outcome move_points(Workspace& ws, const BlockRules& rules, const TetSnapshot& item) {
  for (Index p : item.points) {
    Outcome o = ws.gather(p);
    if (o == Outcome::done) o = optimise(ws, rules);
    if (ws.count(Operation::optimise, o) == Outcome::done) return o;
  }
  return Outcome::no_candidate;
}

/// Tries flips until one improves the worst tet around.
Outcome flip(Workspace& ws, const ImproveRules& step, const TetSnapshot& item) {
  for (int e = 0; e < 6; ++e)
    if (remove_edge(ws, step.relaxed, item.tet, e, full_reach) == Outcome::done) return Outcome::done;
  for (int f = 0; f < 4; ++f)
    if (remove_face(ws, step.rules, item.tet, f, full_reach) == Outcome::done) return Outcome::done;
  return Outcome::no_candidate;
}

}  // namespace

Outcome improve_tet(Workspace& ws, const ImproveRules& step, const TetSnapshot& item) {
  const EditableMesh& mesh = ws.mesh;
  if (!exists(mesh, item)) return Outcome::stale;
  const float quality = mesh.quality(item.tet);
  if (quality > step.bounds.bad_quality) return Outcome::stale;
  const BlockRules &rules = step.rules, &relaxed = step.relaxed;
  const BlockRules& moving = step.last_resort && quality < step.bounds.leave_surface ? relaxed : rules;
  if (step.flips_first && flip(ws, step, item) == Outcome::done) return Outcome::done;
  if (move_points(ws, moving, item) == Outcome::done) return Outcome::done;
  if (!step.flips_first && flip(ws, step, item) == Outcome::done) return Outcome::done;
  for (Index p : item.points) {
    if (mesh.live_tets() <= rules.count.min) break;
    Outcome o = ws.gather(p);
    if (o == Outcome::done) o = collapse(ws, relaxed);
    if (ws.count(Operation::collapse, o) == Outcome::done) return o;
  }
  if (mesh.live_tets() >= rules.count.max) return Outcome::no_candidate;
  for (int e = 0; e < 6; ++e)
    if (insert_in_edge(ws, rules, item.tet, e, InsertionPlace::best, true) == Outcome::done)
      return Outcome::done;
  for (int f = 0; f < 4; ++f)
    if (insert_in_face(ws, rules, item.tet, f, InsertionPlace::best) == Outcome::done) return Outcome::done;
  return insert_in_tet(ws, rules, item.tet, InsertionPlace::best);
}

Outcome perturb_tet(Workspace& ws, const BlockRules& perturbation, const TetSnapshot& item) {
  if (!exists(ws.mesh, item)) return Outcome::stale;
  const auto pick = static_cast<int>(ws.random.below(10));
  return pick < 6 ? remove_edge(ws, perturbation, item.tet, pick, full_reach)
                  : remove_face(ws, perturbation, item.tet, pick - 6, full_reach);
}

BlockRules relaxed_rules(const BlockRules& rules, double edge) {
  BlockRules relaxed = rules;
  if (relaxed.error.max)
    relaxed.error.max = std::max(*relaxed.error.max, Collapses::relaxed_error_edges * edge);
  relaxed.collapse.max_targets = Collapses::relaxed_max_targets;
  relaxed.surface.max_distance = Collapses::relaxed_distance_edges * edge;
  return relaxed;
}

}  // namespace tetwright

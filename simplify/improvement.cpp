#include <algorithm>

#include "simplify/collapse.h"
#include "simplify/engine.h"
#include "simplify/face_removal.h"
#include "simplify/insertion.h"
#include "simplify/smoothing.h"

namespace tetwright {

namespace {

const FlipReach full_reach{7, 5};

/// One tet's turn: the first action that makes the poorest tet around better ends it.
Outcome improve_tet(Task& task, const BlockRules& rules, const ListedTet& item, float limit) {
  EditableMesh& mesh = task.mesh;
  if (const Outcome o = hold(task, item); o != Outcome::done) return o;
  if (mesh.tet(item.tet).quality > limit) return Outcome::stale;
  const auto ends = [](Outcome o) { return o == Outcome::done || o == Outcome::lock_taken; };
  for (Index p : item.points) {
    Outcome o = task.star.gather(mesh, p, task.points);
    if (o == Outcome::done) o = optimise(task, rules);
    task.counts.add(Operation::optimise, o);
    if (ends(o)) return o;
  }
  for (int e = 0; e < 6; ++e)
    if (const Outcome o = remove_edge(task, rules, item.tet, e, full_reach); ends(o)) return o;
  for (int f = 0; f < 4; ++f)
    if (const Outcome o = remove_face(task, rules, item.tet, f, full_reach); ends(o)) return o;
  for (Index p : item.points) {
    if (mesh.live_tets() <= rules.fewest_tets) break;
    Outcome o = task.star.gather(mesh, p, task.points);
    if (o == Outcome::done) o = collapse(task, rules);
    task.counts.add(Operation::collapse, o);
    if (ends(o)) return o;
  }
  if (mesh.live_tets() >= rules.most_tets) return Outcome::no_candidate;
  for (int e = 0; e < 6; ++e)
    if (const Outcome o = insert_in_edge(task, rules, item.tet, e, InsertionPlace::best, true); ends(o))
      return o;
  for (int f = 0; f < 4; ++f)
    if (const Outcome o = insert_in_face(task, rules, item.tet, f, InsertionPlace::best); ends(o)) return o;
  return insert_in_tet(task, rules, item.tet, InsertionPlace::best);
}

}  // namespace

void run_improvement(Engine& engine, const ImprovementPlan& plan) {
  EditableMesh& mesh = engine.mesh();
  BlockRules& rules = engine.rules;
  rules.objective.kind = Objective::Kind::shape;
  rules.accept_worse = 0;
  rules.fewest_tets = plan.fewest_tets;
  rules.most_tets = plan.most_tets;
  rules.slide = &engine.slide();
  engine.squeeze();
  for (int i = 0; i < plan.most_rounds; ++i) {
    Engine::Round round(engine, plan.kind);
    IterationReport& it = round.report();
    std::vector<ListedTet> list = engine.poor_tets(plan.only_below);
    if (list.empty()) break;
    std::sort(list.begin(), list.end(), [&](const ListedTet& a, const ListedTet& b) {
      const float qa = mesh.tet(a.tet).quality, qb = mesh.tet(b.tet).quality;
      return qa != qb ? qa < qb : a.tet < b.tet;
    });
    it.cutoff = plan.only_below;
    it.percent = 100 * static_cast<double>(list.size()) / static_cast<double>(it.tets_before);
    engine.runner().tets_in_order(list, [&](Task& task, const ListedTet& item) {
      return improve_tet(task, rules, item, plan.only_below);
    });
    round.finish();
    std::uint64_t done = 0;
    for (std::size_t o = 0; o < operation_count; ++o)
      done += it.counts.of(static_cast<Operation>(o), Outcome::done);
    if (done == 0) break;
    if (engine.progress()) engine.progress()->update(static_cast<double>(i + 1) / plan.most_rounds);
  }
}

}  // namespace tetwright

#include <algorithm>
#include <functional>
#include <limits>

#include "simplify/collapse.h"
#include "simplify/engine.h"
#include "simplify/face_removal.h"
#include "simplify/insertion.h"
#include "simplify/smoothing.h"

namespace tetwright {

namespace {

const FlipReach full_reach{7, 5};
/// A round that leaves more than this share of the poor tets is followed by one that moves all points around
/// them too, for the tets that stand in their way.
constexpr double stuck_above = 0.8;
/// What collapses that make room for insertions must leave, over the quality that is aimed at.
constexpr float thinning_margin = 1.1f;
/// E of collapses and edge removals, and how far they may leave the surface from the reference, in ideal
/// edges.
constexpr double surgery_error_edges = 12;
constexpr double surgery_distance_edges = 0.3;
constexpr std::size_t surgery_targets = 30;  ///< all neighbours of nearly every point
/// Share of the poor tets that a round must get rid of to count as gain.
constexpr double least_round_gain = 0.02;
/// The same where more than this share of all tets is poor.
constexpr double many_poor = 0.01;
constexpr double least_gain_of_many = 0.05;
/// Rounds without gain before the work ends: while some tets are below ImprovementPlan::leave_surface_below,
/// else.
constexpr int most_idle_rounds = 8;
constexpr int most_idle_rounds_when_good = 2;

/// Qualities (shape_quality()) below which a tet is worked on, and points may leave the surface for it.
struct Bounds {
  float poor, leave_surface;
};

/// One tet's turn: the first action that makes the poorest tet around better ends it.
Outcome improve_tet(Task& task, const BlockRules& rules, const BlockRules& surgery, bool last_resort,
                    const ListedTet& item, const Bounds& bounds) {
  EditableMesh& mesh = task.mesh;
  if (const Outcome o = hold(task, item); o != Outcome::done) return o;
  const float quality = mesh.tet(item.tet).quality;
  if (quality > bounds.poor) return Outcome::stale;
  const BlockRules& moving = last_resort && quality < bounds.leave_surface ? surgery : rules;
  const auto ends = [](Outcome o) { return o == Outcome::done || o == Outcome::lock_taken; };
  for (Index p : item.points) {
    Outcome o = task.star.gather(mesh, p, task.points);
    if (o == Outcome::done) o = optimise(task, moving);
    task.counts.add(Operation::optimise, o);
    if (ends(o)) return o;
  }
  for (int e = 0; e < 6; ++e)
    if (const Outcome o = remove_edge(task, surgery, item.tet, e, full_reach); ends(o)) return o;
  for (int f = 0; f < 4; ++f)
    if (const Outcome o = remove_face(task, rules, item.tet, f, full_reach); ends(o)) return o;
  for (Index p : item.points) {
    if (mesh.live_tets() <= rules.fewest_tets) break;
    Outcome o = task.star.gather(mesh, p, task.points);
    if (o == Outcome::done) o = collapse(task, surgery);
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

/// A flip of the tet that leaves nothing poor or is better, chosen at random: other
/// connectivity near a tet that nothing helps.
Outcome shake_tet(Task& task, const BlockRules& shaking, const ListedTet& item) {
  if (const Outcome o = hold(task, item); o != Outcome::done) return o;
  const auto pick = static_cast<int>(task.random.below(10));
  return pick < 6 ? remove_edge(task, shaking, item.tet, pick, full_reach)
                  : remove_face(task, shaking, item.tet, pick - 6, full_reach);
}

}  // namespace

int run_improvement(Engine& engine, const ImprovementPlan& plan) {
  EditableMesh& mesh = engine.mesh();
  BlockRules& rules = engine.rules;
  const auto quality = [&](double angle) {
    return static_cast<float>(std::min(0.99, shape_quality_bound(rules.objective.shape, angle)));
  };
  const Bounds bounds{quality(plan.angle), quality(plan.leave_surface_angle)};
  rules.objective.kind = Objective::Kind::shape;
  rules.accept_worse = 0;
  rules.fewest_tets = plan.fewest_tets;
  rules.most_tets = plan.most_tets;
  rules.slide = &engine.slide();
  engine.squeeze();
  for (int sweep = 0; sweep < plan.fit_sweeps; ++sweep) {
    Engine::Round round(engine, plan.kind);
    engine.fit_interfaces(bounds.poor);
    round.finish();
  }
  // Cutting off an ear or turning an edge sweeps much volume for the little that the surface moves: there the
  // distance from the reference decides.
  BlockRules surgery = rules;
  const double edge = rules.objective.quality.ideal_edge;
  surgery.largest_error = std::max(rules.largest_error, surgery_error_edges * edge);
  surgery.leave_surface = true;
  surgery.most_targets = surgery_targets;
  surgery.largest_distance = surgery_distance_edges * edge;
  std::size_t fewest_poor = 4 * mesh.live_tets();
  int idle = 0;
  std::vector<ListedTet> tried;  // in the last round, by number
  int i = 0;
  for (; i < plan.most_rounds; ++i) {
    std::vector<ListedTet> list = engine.poor_tets(bounds.poor);
    if (list.empty()) break;
    const bool bad = std::any_of(list.begin(), list.end(), [&](const ListedTet& t) {
      return mesh.tet(t.tet).quality < bounds.leave_surface;
    });
    const bool stuck = static_cast<double>(list.size()) > stuck_above * static_cast<double>(fewest_poor);
    const double gain = 1 - static_cast<double>(list.size()) / static_cast<double>(fewest_poor);
    // Where very many resist, it is the interfaces that hold them, and more rounds would take long for
    // little.
    const bool many = static_cast<double>(list.size()) > many_poor * static_cast<double>(mesh.live_tets());
    idle = gain >= (many ? least_gain_of_many : least_round_gain) ? 0 : idle + 1;
    if (idle >= ((bad && !many) ? most_idle_rounds : most_idle_rounds_when_good)) break;
    fewest_poor = std::min(fewest_poor, list.size());
    const bool last_resort = stuck && idle > 0;
    Engine::Round round(engine, plan.kind);
    IterationReport& it = round.report();
    it.cutoff = plan.angle;
    it.percent = 100 * static_cast<double>(list.size()) / static_cast<double>(it.tets_before);
    // Room for insertions: where all is good, or gets better, points go.
    if (2 * mesh.live_tets() > plan.target_tets + plan.most_tets) {
      BlockRules thinning = rules;
      thinning.good_enough = bounds.poor * thinning_margin;
      thinning.fewest_tets = plan.target_tets;
      engine.each_star(
          plan.local ? engine.points_around(list) : engine.poor_points(1), Operation::collapse,
          [&](Task& task) { return collapse(task, thinning); },
          [&] { return mesh.live_tets() <= plan.target_tets; });
    }
    if (last_resort) {
      BlockRules shaking = surgery;
      shaking.good_enough = bounds.poor;
      engine.runner().tets(
          engine.tets_around(list),
          [&](Task& task, const ListedTet& item) { return shake_tet(task, shaking, item); },
          [] { return false; });
    }
    if (stuck) {
      std::vector<Index> around = engine.points_around(list);
      if (!last_resort) std::erase_if(around, [&](Index p) { return !mesh.touched(p); });
      engine.each_star(around, Operation::optimise, [&](Task& task) { return optimise(task, rules); });
    }
    // What was tried in the last round comes again only where something changed, or where more is allowed.
    std::vector<ListedTet> tries;
    if (last_resort) {
      tries = list;
    } else {
      const auto same = [](const ListedTet& a, const ListedTet& b) { return a.tet < b.tet; };
      for (const ListedTet& t : list) {
        const auto known = std::lower_bound(tried.begin(), tried.end(), t, same);
        if (known == tried.end() || known->tet != t.tet || known->points != t.points ||
            std::any_of(t.points.begin(), t.points.end(), [&](Index p) { return mesh.touched(p); }))
          tries.push_back(t);
      }
    }
    tried = std::move(list);
    mesh.begin_round();
    std::sort(tries.begin(), tries.end(), [&](const ListedTet& a, const ListedTet& b) {
      const float qa = mesh.tet(a.tet).quality, qb = mesh.tet(b.tet).quality;
      return qa != qb ? qa < qb : a.tet < b.tet;
    });
    engine.runner().tets_in_order(tries, [&](Task& task, const ListedTet& item) {
      return improve_tet(task, rules, surgery, last_resort, item, bounds);
    });
    round.finish();
    if (engine.progress()) engine.progress()->update(static_cast<double>(i + 1) / plan.most_rounds);
  }
  return i;
}

}  // namespace tetwright

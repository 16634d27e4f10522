#include "simplify/schedule/paper_schedule.h"

#include <algorithm>
#include <cmath>

#include "common/portable_math.h"
#include "common/tolerances.h"
#include "simplify/operations/collapse.h"
#include "simplify/operations/edge_removal.h"
#include "simplify/operations/face_removal.h"
#include "simplify/operations/insertion.h"
#include "simplify/operations/smoothing.h"
#include "simplify/schedule/schedule_constants.h"

namespace tetwright {

namespace {

/// Around the target, once it is reached: actions that leave this band are not taken.
constexpr double count_slack = 0.005;

/// The tet's half-edge of least weight that passes every test.
Outcome collapse_tet(Workspace& ws, const BlockRules& rules, const ListedTet& item) {
  EditableMesh& mesh = ws.mesh;
  struct HalfEdge {
    double weight;
    Index from, to;
  };
  std::array<HalfEdge, 12> edges;
  std::size_t count = 0;
  Outcome refusal = Outcome::material_rule;
  for (Index from : item.points) {
    Star& star = ws.star;
    if (const Outcome o = star.gather(mesh, from, ws.points); o != Outcome::done) return o;
    const int dimension = star.dimension();
    if (dimension == 0) continue;
    star.compute_gradients();
    for (std::size_t p = 0; p < star.points.size(); ++p) {
      if (std::find(item.points.begin(), item.points.end(), star.points[p]) == item.points.end()) continue;
      if (star.edge_dimension(p) != dimension) continue;
      const double weight = collapse_weight(star, p, rules);
      if (weight <= rules.max_error) {
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
    if (const Outcome o = star.gather(mesh, edges[i].from, ws.points); o != Outcome::done) return o;
    const auto b = std::find(star.points.begin(), star.points.end(), edges[i].to) - star.points.begin();
    refusal = collapse_onto(ws, rules, static_cast<std::size_t>(b));
    if (refusal == Outcome::done || refusal == Outcome::lock_taken) break;
  }
  return refusal;
}

/// One tet's turn: the actions of section 4 in their order; the first that succeeds ends it.
Outcome paper_turn(Workspace& ws, const BlockRules& rules, const ListedTet& item, float limit) {
  EditableMesh& mesh = ws.mesh;
  if (const Outcome o = validate(ws, item); o != Outcome::done) return o;
  if (mesh.tet(item.tet).quality > limit) return Outcome::stale;
  const auto ends = [](Outcome o) { return o == Outcome::done || o == Outcome::lock_taken; };
  for (int f = 0; f < 4; ++f)
    if (const Outcome o = remove_face(ws, rules, item.tet, f, basic_reach); ends(o)) return o;
  for (int e = 0; e < 6; ++e)
    if (const Outcome o = remove_edge(ws, rules, item.tet, e, basic_reach); ends(o)) return o;
  {
    const Outcome o = collapse_tet(ws, rules, item);
    ws.counts.add(Operation::collapse, o);
    if (ends(o)) return o;
  }
  // "move each vertex of the element": all four, whatever becomes of the others.
  bool moved = false;
  for (Index p : item.points) {
    Outcome o = ws.star.gather(mesh, p, ws.points);
    if (o == Outcome::done) o = smooth(ws, rules);
    ws.counts.add(Operation::smooth, o);
    ws.cells.release();
    if (o == Outcome::lock_taken && !moved) return o;
    moved |= o == Outcome::done;
  }
  if (moved) return Outcome::done;
  // New points must better the tets they go into: what annealing lets pass would be split for ever.
  BlockRules strict = rules;
  strict.accept_worse = 0;
  if (const Outcome o = insert_in_tet(ws, strict, item.tet, InsertionPlace::centre); ends(o)) return o;
  for (int f = 0; f < 4; ++f)
    if (const Outcome o = insert_in_face(ws, strict, item.tet, f, InsertionPlace::centre); ends(o)) return o;
  for (int e = 0; e < 6; ++e)
    if (const Outcome o = insert_in_edge(ws, strict, item.tet, e, InsertionPlace::centre, false); ends(o))
      return o;
  return Outcome::no_candidate;
}

std::size_t below_angle(const EditableMesh& mesh, double angle) {
  std::size_t count = 0;
  for (Index t = 0; t < mesh.tet_slots(); ++t) {
    const Tet& p = mesh.tet(t).points;
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
  const double max_interpolation_error = max_useful_error * std::max(1.0, options.gamma / 10);
  rules.objective.kind = Objective::Kind::paper;
  rules.max_error = rules.objective.quality.ideal_edge;
  rules.annealing_floor = 0;
  rules.losses_cancel = true;
  rules.min_tets = static_cast<std::size_t>(std::ceil(target * (1 - count_slack)));
  engine.compact();
  double percent = percent_step;
  int idle = 0;
  bool reached = false;
  std::size_t poor = mesh.live_tets();
  for (int i = 0; i < options.max_iterations && idle < max_idle_iterations; ++i) {
    reached = reached || mesh.live_tets() <= target_tets;
    if (reached) {
      // The second stop. The counts of poor tets tell whether anything is still gained.
      const std::size_t now = below_angle(mesh, options.min_solid_angle);
      if (now == 0) break;
      idle = now < poor ? 0 : idle + 1;
      poor = now;
    }
    engine.compact_if_sparse();
    Engine::Round round(engine, "simplify");
    IterationReport& it = round.report();
    it.percent = percent;
    const auto before = static_cast<double>(it.tets_before);
    const double log_now = portable_log(std::max(before / target, 1.0));
    rules.accept_worse = reached ? 0 : first_annealing * std::clamp(log_now / log_first, 0.0, 1.0);
    // Before, whatever does not undo the iterations before it; then only what keeps or restores the count.
    rules.max_tets = reached ? static_cast<std::size_t>(target * (1 + count_slack)) : it.tets_before;
    const float limit = engine.cutoff(percent);
    it.cutoff = portable_cbrt(limit);
    engine.runner().tets(
        engine.poor_tets(limit),
        [&](Workspace& ws, const ListedTet& item) { return paper_turn(ws, rules, item, limit); },
        [&] { return !reached && mesh.live_tets() <= target_tets; });
    round.finish();
    if (!reached) {
      const auto after = static_cast<double>(mesh.live_tets());
      const bool error_grows = rules.max_error < max_interpolation_error;
      if (percent >= 100 && !error_grows) idle = 1 - after / before < idle_below ? idle + 1 : 0;
      rules.max_error =
          std::min(max_interpolation_error, rules.max_error * std::max(1.0, portable_cbrt(after / target)));
    }
    percent = std::min(100.0, percent + percent_step);
    if (engine.progress()) engine.progress()->update(1 - log_now / log_first);
  }
  rules.accept_worse = 0;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/bulk_improvement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/geometry/predicates.h"
#include "common/portable_math.h"
#include "simplify/operations/collapse.h"
#include "simplify/operations/edge_removal.h"
#include "simplify/operations/face_removal.h"
#include "simplify/operations/insertion.h"
#include "simplify/operations/smoothing.h"
#include "simplify/schedule/improve_step.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using BulkRounds = SimplifyTuning::BulkRounds;

/// Cube of the edge of the regular tet of volume 1: 6 sqrt(2).
constexpr double cubed_edge_of_unit_volume = 8.48528137423857;

double local_edge(double volume, std::size_t tets) {
  return portable_cbrt(cubed_edge_of_unit_volume * volume / static_cast<double>(tets));
}

/// Tries flips until one improves the worst tet.
Outcome flip_tet(Workspace& ws, const BlockRules& rules, const TetSnapshot& item, float bad_quality) {
  if (!exists(ws.mesh, item) || ws.mesh.quality(item.tet) > bad_quality) return Outcome::stale;
  for (int e = 0; e < 6; ++e)
    if (remove_edge(ws, rules, item.tet, e, full_reach) == Outcome::done) return Outcome::done;
  for (int f = 0; f < 4; ++f)
    if (remove_face(ws, rules, item.tet, f, full_reach) == Outcome::done) return Outcome::done;
  return Outcome::no_candidate;
}

/// Splits the tet's longest surface edge if it is long relative to its surroundings.
Outcome split_tet(Workspace& ws, const BlockRules& rules, const TetSnapshot& item, float bad_quality) {
  const EditableMesh& mesh = ws.mesh;
  if (!exists(mesh, item) || mesh.quality(item.tet) > bad_quality) return Outcome::stale;
  int longest = -1;
  double longest2 = 0;
  for (int e = 0; e < 6; ++e) {
    if (ws.ring.gather(mesh, item.tet, e) != Outcome::done || ws.ring.interface_triangles == 0) continue;
    const double length2 = (mesh.position(ws.ring.a) - mesh.position(ws.ring.b)).squaredNorm();
    if (length2 <= longest2) continue;
    double volume = 0;
    for (Index t : ws.ring.tets) volume += mesh.signed_volume(t);
    const double local = BulkRounds::long_edge * local_edge(volume, ws.ring.tets.size());
    if (length2 < local * local) continue;
    longest = e;
    longest2 = length2;
  }
  if (longest < 0) return Outcome::no_candidate;
  return insert_in_edge(ws, rules, item.tet, longest, InsertionPlace::centre, false);
}

/// Whether the centre of the gathered star has an edge that is short relative to the star.
bool crowded(const EditableMesh& mesh, const Star& star) {
  double shortest2 = std::numeric_limits<double>::infinity(), volume = 0;
  for (const Vec3& p : star.positions)
    shortest2 = std::min(shortest2, (p - star.centre_position).squaredNorm());
  for (const Star::StarTet& t : star.tets) volume += mesh.signed_volume(t.tet);
  const double local = BulkRounds::short_edge * local_edge(volume, star.tets.size());
  return shortest2 < local * local;
}

class BulkLoop {
 public:
  BulkLoop(const ImprovementTools& tools, ImprovementArea& area, const BulkPlan& plan)
      : mesh_(tools.mesh),
        runner_(tools.runner),
        recorder_(tools.recorder),
        area_(area),
        plan_(plan),
        moving_(tools.rules),
        flipping_(relaxed_rules(tools.rules, area.usual_edge())) {
    moving_.count = flipping_.count = {plan.min_tets, plan.max_tets};
    perturbing_ = resizing_ = flipping_;
    perturbing_.acceptance.good_enough = plan.bad_quality;
    resizing_.acceptance.worse_probability = 1;
    resizing_.acceptance.worse_floor = BulkRounds::resize_floor;
  }

  int run() {
    std::size_t min_bad = std::numeric_limits<std::size_t>::max();
    int idle = 0, i = 0;
    for (; i < plan_.max_rounds; ++i) {
      const std::size_t bad = area_.bad_tets(plan_.bad_quality).size();
      if (bad == 0) break;
      if (static_cast<double>(bad) > BulkRounds::idle_above * static_cast<double>(min_bad)) ++idle;
      if (idle > (plan_.remodel ? BulkRounds::max_idle : 0)) break;
      min_bad = std::min(min_bad, bad);
      run_round(bad, i == 0);
    }
    return i;
  }

 private:
  void run_round(std::size_t bad_count, bool first) {
    RoundRecorder::Round round(recorder_, plan_.kind, moving_.error.limit());
    const auto count = static_cast<double>(bad_count);
    round.report().percent = 100 * count / static_cast<double>(mesh_.live_tets());
    if (plan_.remodel) {
      if (count > BulkRounds::resize_above * static_cast<double>(area_.tet_count())) resize();
      perturb();
    }
    std::vector<TetSnapshot> bad = area_.bad_tets(plan_.bad_quality);
    // Retry failures only where something has changed.
    if (!first)
      std::erase_if(bad, [&](const TetSnapshot& t) {
        return std::none_of(t.points.begin(), t.points.end(), [&](Index p) { return mesh_.touched(p); });
      });
    mesh_.begin_round();
    each_tet(bad, [&](Workspace& ws, const TetSnapshot& item) {
      return flip_tet(ws, flipping_, item, plan_.bad_quality);
    });
    runner_.each_star(plan_.remodel ? area_.points_around(bad) : area_.bad_points(plan_.bad_quality),
                      Operation::optimise, [&](Workspace& ws) { return optimise(ws, moving_); });
    round.finish();
  }

  void perturb() {
    each_tet(area_.tets_around(area_.bad_tets(plan_.bad_quality)),
             [&](Workspace& ws, const TetSnapshot& item) { return perturb_tet(ws, perturbing_, item); });
  }

  void resize() {
    runner_.each_star(area_.bad_points(plan_.bad_quality), Operation::collapse, [&](Workspace& ws) {
      return crowded(ws.mesh, ws.star) ? collapse(ws, resizing_) : Outcome::no_candidate;
    });
    each_tet(area_.bad_tets(plan_.bad_quality), [&](Workspace& ws, const TetSnapshot& item) {
      return split_tet(ws, resizing_, item, plan_.bad_quality);
    });
  }

  template <class Attempt>
  void each_tet(const std::vector<TetSnapshot>& tets, const Attempt& attempt) {
    runner_.tets(
        tets, [&](Workspace& ws, const TetSnapshot& item, int) { return attempt(ws, item); },
        [] { return false; });
  }

  EditableMesh& mesh_;
  BlockRunner& runner_;
  RoundRecorder& recorder_;
  ImprovementArea& area_;
  const BulkPlan& plan_;
  BlockRules moving_, flipping_, perturbing_, resizing_;
};

}  // namespace

int run_bulk_improvement(const ImprovementTools& tools, ImprovementArea& area, const BulkPlan& plan) {
  return BulkLoop(tools, area, plan).run();
}

}  // namespace tetwright

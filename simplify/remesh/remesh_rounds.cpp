// SPDX-License-Identifier: Apache-2.0
#include "simplify/remesh/remesh_rounds.h"

#include "simplify/operations/collapse.h"
#include "simplify/operations/insertion.h"
#include "simplify/schedule/improve_area.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using Remeshing = SimplifyTuning::Remeshing;

}  // namespace

RemeshRounds::RemeshRounds(const ImprovementTools& tools, ChangeJournal& journal,
                           const std::vector<Index>& region, const std::vector<Index>& with_rim)
    : rules_(tools.rules),
      tools_{tools.mesh, tools.runner, rules_, tools.recorder},
      region_(region),
      area_(tools.mesh, tools.runner, journal, region, with_rim) {
  rules_.error.max = area_.usual_edge();
}

void RemeshRounds::coarsen(double size, float floor) {
  BlockRules rules = rules_;
  rules.error.max.reset();
  rules.collapse.max_collapsed_edge = Remeshing::short_edge * size;
  rules.collapse.max_new_edge = Remeshing::long_edge * size;
  rules.surface.max_distance = Remeshing::coarsening_distance * size;
  rules.acceptance.good_enough = floor;
  std::vector<Index> points = area_.first_points(), changed;
  for (int round = 0; round < Remeshing::max_coarsening_rounds && !points.empty(); ++round) {
    tools_.runner.each_star(points, Operation::collapse, [&](Workspace& ws) { return collapse(ws, rules); });
    points = area_.take_changed_points(LocalArea::Part::inner);
    changed.insert(changed.end(), points.begin(), points.end());
  }
  area_.look_around(std::move(changed));
}

void RemeshRounds::refine(double size, float floor) {
  const EditableMesh& mesh = tools_.mesh;
  BlockRules rules = rules_;
  rules.acceptance.good_enough = floor;
  const double limit = Remeshing::long_edge * size;
  std::vector<Index> tets = region_, changed;
  for (int round = 0; round < Remeshing::max_refining_rounds && !tets.empty(); ++round) {
    std::vector<TetSnapshot> items;
    items.reserve(tets.size());
    for (Index t : tets) items.push_back({t, mesh.points(t)});
    tools_.runner.tets(
        items,
        [&](Workspace& ws, const TetSnapshot& item, int) {
          if (!exists(mesh, item)) return Outcome::stale;
          int longest = -1;
          double length = limit;
          for (int e = 0; e < 6; ++e) {
            const Index p = item.points[tet_edges[e][0]], q = item.points[tet_edges[e][1]];
            if (const double l = (mesh.position(p) - mesh.position(q)).norm(); l > length) {
              longest = e;
              length = l;
            }
          }
          if (longest < 0) return Outcome::no_candidate;
          return insert_in_edge(ws, rules, item.tet, longest, InsertionPlace::centre, true);
        },
        [] { return false; });
    const std::vector<Index> points = area_.take_changed_points(LocalArea::Part::inner);
    changed.insert(changed.end(), points.begin(), points.end());
    tets = area_.tets_at(points, LocalArea::Part::inner);
  }
  area_.look_around(std::move(changed));
}

int RemeshRounds::improve(const ImprovementPlan& plan) {
  return improve_area(tools_, area_, plan, Remeshing::bulk_before);
}

}  // namespace tetwright

#pragma once

#include <algorithm>

#include "simplify/cavity.h"
#include "simplify/task.h"

namespace tetwright {

/// Replaces the tets: links the new ones with each other and with what lies around, gives all their points a
/// living tet. Faces of the cavity's hull that no new tet has must have been on the boundary of the mesh. The
/// task holds every point of the old and new tets and has slots reserved for those beyond the old ones'
/// number; counting is the caller's.
void refill(Task& task, const Cavity& cavity);

inline bool contains(const Tet& t, Index p) { return t[0] == p || t[1] == p || t[2] == p || t[3] == p; }

/// True if `test(points of the tet)` holds for one tet at a held point: walks its star by ids alone.
template <class F>
bool any_in_star(Task& task, Index point, const F& test) {
  const EditableMesh& mesh = task.mesh;
  std::vector<Index>& walk = task.walk;
  task.numbers.clear();
  walk.clear();
  bool added;
  walk.push_back(mesh.hint(point));
  task.numbers.number(walk[0], added);
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const TetRecord& r = mesh.tet(walk[i]);
    if (test(r.points)) return true;
    for (int k = 0; k < 4; ++k) {
      if (r.points[k] == point || r.neighbours[k] == no_index) continue;
      task.numbers.number(r.neighbours[k], added);
      if (added) walk.push_back(r.neighbours[k]);
    }
  }
  return false;
}

/// True if an edge of the mesh joins the held point p to q.
inline bool joined(Task& task, Index p, Index q) {
  return any_in_star(task, p, [q](const Tet& t) { return contains(t, q); });
}

/// True if the gathered ring has all tets at its edge: where wedges of material touch along an edge it has
/// only one.
inline bool whole_ring(Task& task) {
  const EdgeRing& ring = task.ring;
  std::size_t count = 0;
  any_in_star(task, ring.a, [&](const Tet& t) {
    count += contains(t, ring.b);
    return false;
  });
  return count == ring.tets.size();
}

/// Locks a point unless the task holds it.
inline bool hold_point(Task& task, Index p) { return task.points.holds(p) || task.points.try_lock(p); }

inline float quality_of(const EditableMesh& mesh, const BlockRules& rules, const Tet& t) {
  return rules.objective(mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2]), mesh.position(t[3]));
}

/// What the poorest new tet must exceed: the poorest old one, or less where annealing lets the action pass
/// (one draw).
inline float acceptance_limit(Task& task, const BlockRules& rules, float poorest) {
  const bool may_worsen = rules.accept_worse > 0 && task.random.uniform() < rules.accept_worse;
  return std::min(rules.good_enough, may_worsen ? rules.annealing_floor * poorest : poorest);
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "simplify/mesh/star_walk.h"

namespace tetwright {

/// Finds the tets around points and the points of tets, in time proportional to the lists, not to the mesh.
/// Reuses its memory; one thread at a time.
class Neighbourhood {
 public:
  /// The tets at live points for which keep(tet) is true; each once, ascending.
  template <class Keep>
  std::vector<Index> tets_at(const EditableMesh& mesh, const std::vector<Index>& points, const Keep& keep) {
    std::vector<Index> tets;
    seen_.clear();
    for (Index p : points)
      walk_.any_tet(mesh, p, [&](Index t) {
        if (is_new(t) && keep(t)) tets.push_back(t);
        return false;
      });
    std::sort(tets.begin(), tets.end());
    return tets;
  }
  std::vector<Index> tets_at(const EditableMesh& mesh, const std::vector<Index>& points) {
    return tets_at(mesh, points, [](Index) { return true; });
  }

  /// The points of live tets; each once, ascending.
  std::vector<Index> points_of(const EditableMesh& mesh, const std::vector<Index>& tets) {
    std::vector<Index> points;
    seen_.clear();
    for (Index t : tets)
      for (Index p : mesh.points(t))
        if (is_new(p)) points.push_back(p);
    std::sort(points.begin(), points.end());
    return points;
  }

  /// Sorts the list and removes duplicates; fast if most numbers occur many times.
  void make_distinct(std::vector<Index>& list) {
    seen_.clear();
    std::erase_if(list, [&](Index i) { return !is_new(i); });
    std::sort(list.begin(), list.end());
  }

 private:
  bool is_new(Index i) {
    bool added;
    seen_.number(i, added);
    return added;
  }

  StarWalk walk_;
  LocalNumbers seen_;  ///< tets or points, within one call
};

}  // namespace tetwright

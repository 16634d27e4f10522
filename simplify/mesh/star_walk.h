// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simplify/mesh/edge_ring.h"
#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/local_numbers.h"

namespace tetwright {

inline bool contains(const Tet& t, Index p) { return t[0] == p || t[1] == p || t[2] == p || t[3] == p; }

/// Walks the star of a point from tet to tet without reading positions. Reuses its memory.
class StarWalk {
 public:
  /// Whether test(tet) is true for some tet at `point`; stops at the first.
  /// \pre The point is live.
  template <class Test>
  bool any_tet(const EditableMesh& mesh, Index point, const Test& test) {
    numbers_.clear();
    tets_.clear();
    bool added;
    tets_.push_back(mesh.incident_tet(point));
    numbers_.number(tets_[0], added);
    for (std::size_t i = 0; i < tets_.size(); ++i) {
      const Index t = tets_[i];
      if (test(t)) return true;
      const Tet& corners = mesh.points(t);
      for (int k = 0; k < 4; ++k) {
        const Index other = mesh.neighbour(t, k);
        if (corners[k] == point || other == no_index) continue;
        numbers_.number(other, added);
        if (added) tets_.push_back(other);
      }
    }
    return false;
  }

  /// any_tet() with test(points of the tet).
  template <class Test>
  bool any(const EditableMesh& mesh, Index point, const Test& test) {
    return any_tet(mesh, point, [&](Index t) { return test(mesh.points(t)); });
  }

  /// Whether an edge of the mesh joins p to q.
  bool joined(const EditableMesh& mesh, Index p, Index q) {
    return any(mesh, p, [q](const Tet& t) { return contains(t, q); });
  }

  /// Whether a gathered ring has all tets at its edge. If wedges of material touch along an edge, a ring
  /// contains the tets of only one wedge.
  bool is_whole(const EditableMesh& mesh, const EdgeRing& ring) {
    std::size_t count = 0;
    any(mesh, ring.a, [&](const Tet& t) {
      count += contains(t, ring.b);
      return false;
    });
    return count == ring.tets.size();
  }

 private:
  LocalNumbers numbers_;
  std::vector<Index> tets_;
};

}  // namespace tetwright

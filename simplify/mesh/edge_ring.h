// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/outcome.h"

namespace tetwright {

/// The tets around an edge, in order.
struct EdgeRing {
  /// Tets a ring may have: that of two chains of seven.
  static constexpr std::size_t max_tets = 14;

  Index a = no_index, b = no_index;  ///< the edge's ends
  bool closed = false;               ///< no boundary at the edge
  /// (a, b, points[i], points[i + 1]) is tets[i], listed as a positive tet; of a closed ring points[n] is
  /// points[0] again and not repeated.
  std::vector<Index> points;
  std::vector<Index> tets;
  std::vector<RegionId> regions;  ///< of the tets
  float worst = 1;                ///< quality of the tets
  int interface_triangles = 0;    ///< interface triangles at the edge

  /// Walks around the edge `edge` of tet_edges of a tet: done, or too_large where there are more than `limit`
  /// tets.
  Outcome gather(const EditableMesh& mesh, Index tet, int edge, std::size_t limit = max_tets);

  /// Of the edge: 3 within a material, 2 on an interface, 1 on a junction curve.
  int dimension() const { return interface_triangles == 0 ? 3 : interface_triangles == 2 ? 2 : 1; }
  /// Of a closed ring with an interface: turns it so that the first interface triangle is that of points[0].
  void begin_at_interface();
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simplify/mesh/editable_mesh.h"
#include "tetwright/simplify.h"

namespace tetwright {

/// The tets around an edge, in order.
struct EdgeRing {
  /// Max tets of a ring: two chains of seven.
  static constexpr std::size_t max_tets = 14;

  Index a = no_index, b = no_index;  ///< the edge's ends
  bool closed = false;               ///< no boundary at the edge
  /// (a, b, points[i], points[i + 1]) is tets[i], positive. A closed ring does not repeat points[0] at the
  /// end.
  std::vector<Index> points;
  std::vector<Index> tets;
  std::vector<RegionId> regions;  ///< of the tets
  /// By tet: whether the face (a, b, points[i]) of tets[i] is an interface triangle.
  std::vector<std::uint8_t> behind_interface;
  float worst = 1;              ///< min quality of the tets
  int interface_triangles = 0;  ///< interface triangles at the edge

  /// Walks around an edge of a tet.
  ///
  /// \param edge index into tet_edges.
  /// \return done; too_large if the ring has more than `limit` tets.
  Outcome gather(const EditableMesh& mesh, Index tet, int edge, std::size_t limit = max_tets);

  /// Dimension of the edge: 3 within a material, 2 on an interface, 1 on a junction curve or the border of a
  /// sheet.
  int dimension() const { return interface_triangles == 0 ? 3 : interface_triangles == 2 ? 2 : 1; }
  /// Rotates a closed ring at an interface so that points[0] is on the first interface triangle.
  void begin_at_interface();
};

}  // namespace tetwright

#pragma once

#include <vector>

#include "simplify/editable_mesh.h"
#include "simplify/outcome.h"

namespace tetwright {

/// The tets around an edge, in order.
struct EdgeRing {
  /// Tets a ring may have: that of two chains of seven.
  static constexpr std::size_t most_tets = 14;

  Index a = no_index, b = no_index;  ///< the edge's ends
  bool closed = false;               ///< no boundary at the edge
  /// (a, b, points[i], points[i + 1]) is tets[i], listed as a positive tet; of a closed ring points[n] is
  /// points[0] again and not repeated.
  std::vector<Index> points;
  std::vector<Index> tets;
  std::vector<Region> regions;  ///< of the tets
  float poorest = 1;            ///< quality of the tets
  int sheets = 0;               ///< interface triangles at the edge

  /// Walks around the edge `edge` of tet_edges of a tet whose four points are held, and locks what it meets:
  /// done, lock_taken, or too_large.
  Outcome gather(const EditableMesh& mesh, Index tet, int edge, HeldLocks& held);

  /// Of the edge: 3 within a material, 2 on an interface, 1 on a junction curve.
  int dimension() const { return sheets == 0 ? 3 : sheets == 2 ? 2 : 1; }
  /// Of a closed ring with an interface: turns it so that the first sheet is that of points[0].
  void begin_at_sheet();
};

}  // namespace tetwright

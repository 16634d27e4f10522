// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/surface_cells.h"

#include <algorithm>

#include "common/features/edge_uses.h"
#include "common/mesh/disjoint_sets.h"

namespace tetwright {

namespace {

/// A triangle at an edge, seen along the edge.
struct AtEdge {
  double x, y;  ///< direction from the edge into the triangle
  Index triangle;
  bool front_next;  ///< the front is on the counter-clockwise side

  bool upper() const { return y > 0 || (y == 0 && x > 0); }
  bool operator<(const AtEdge& o) const {
    if (upper() != o.upper()) return upper();
    const double turn = x * o.y - y * o.x;
    return turn != 0 ? turn > 0 : triangle < o.triangle;
  }
};

}  // namespace

SurfaceCells find_cells(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  DisjointSets sides(2 * triangles.size()), pieces(triangles.size());
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  std::vector<AtEdge> around;
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].key == uses[i].key) ++j;
    const auto [a, b] = ends_of(uses[i].key);
    const Vec3 along = (points[b] - points[a]).normalized();
    const Vec3 u = along.unitOrthogonal(), v = along.cross(u);
    around.clear();
    for (std::size_t k = i; k < j; ++k) {
      const Triangle& t = triangles[uses[k].triangle];
      const Index apex = t[0] ^ t[1] ^ t[2] ^ a ^ b;
      const Vec3 out = points[apex] - points[a];
      // Seen against `along`, a triangle that runs from a to b has its front counter-clockwise of it.
      around.push_back({out.dot(u), out.dot(v), uses[k].triangle, uses[k].ascending});
      pieces.unite(uses[i].triangle, uses[k].triangle);
    }
    std::sort(around.begin(), around.end());
    for (std::size_t k = 0; k < around.size(); ++k) {
      const AtEdge &here = around[k], &next = around[(k + 1) % around.size()];
      sides.unite(2 * here.triangle + (here.front_next ? 1 : 0),
                  2 * next.triangle + (next.front_next ? 0 : 1));
    }
  }
  SurfaceCells cells;
  std::vector<Index> number(2 * triangles.size(), no_index), piece(triangles.size(), no_index);
  const auto numbered = [](std::vector<Index>& numbers, Index root, Index& count) {
    if (numbers[root] == no_index) numbers[root] = count++;
    return numbers[root];
  };
  Index piece_count = 0;
  for (Index t = 0; t < triangles.size(); ++t) {
    cells.sides.push_back({});
    for (Index side = 0; side < 2; ++side)
      cells.sides.back()[side] = numbered(number, sides.root(2 * t + side), cells.count);
    cells.piece.push_back(numbered(piece, pieces.root(t), piece_count));
  }
  return cells;
}

}  // namespace tetwright

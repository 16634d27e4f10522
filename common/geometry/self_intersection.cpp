// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/self_intersection.h"

#include <algorithm>

#include "common/geometry/box_tree.h"
#include "common/geometry/triangle_intersection.h"
#include "common/parallel/parallel_sort.h"

namespace tetwright {

namespace {

constexpr std::size_t leaf_size = 4;
constexpr std::size_t nodes_per_chunk = 512;

}  // namespace

std::vector<std::pair<Index, Index>> self_intersections(std::span<const Vec3> points,
                                                        std::span<const Triangle> triangles) {
  std::vector<Box3> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (Index v : triangles[t]) boxes[t].add(points[v]);
  const std::vector<Index> order = morton_order(boxes);
  const BoxTree tree(order.size(), leaf_size, [&](std::size_t i) { return boxes[order[i]]; });
  const auto with_points = [&](Index t) {
    const Triangle& ids = triangles[t];
    return MeshTriangle{ids, {points[ids[0]], points[ids[1]], points[ids[2]]}};
  };
  const std::span<const BoxTree::Node> nodes = tree.nodes();
  std::vector<std::pair<Index, Index>> out = parallel_collect<std::pair<Index, Index>>(
      0, nodes.size(), nodes_per_chunk,
      [&](std::size_t begin, std::size_t end, std::vector<std::pair<Index, Index>>& found) {
        for (std::size_t k = begin; k < end; ++k) {
          if (!tree.is_leaf(nodes[k])) continue;
          tree.for_each_later_intersecting_leaf(k, [&](std::size_t l) {
            for (std::size_t i = nodes[k].begin; i < nodes[k].end; ++i)
              for (std::size_t j = std::max<std::size_t>(nodes[l].begin, i + 1); j < nodes[l].end; ++j) {
                const Index f = order[i], g = order[j];
                if (boxes[f].intersects(boxes[g]) && triangles_intersect(with_points(f), with_points(g)))
                  found.emplace_back(std::min(f, g), std::max(f, g));
              }
          });
        }
      });
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/self_intersection.h"

#include "common/geometry/box_pairs.h"
#include "common/geometry/triangle_intersection.h"

namespace tetwright {

std::vector<std::pair<Index, Index>> self_intersections(std::span<const Vec3> points,
                                                        std::span<const Triangle> triangles) {
  std::vector<Box3> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (Index v : triangles[t]) boxes[t].add(points[v]);
  const auto with_points = [&](Index t) {
    const Triangle& ids = triangles[t];
    return MeshTriangle{ids, {points[ids[0]], points[ids[1]], points[ids[2]]}};
  };
  std::vector<std::pair<Index, Index>> out;
  for (const auto& [f, g] : intersecting_pairs(
           boxes, [&](Index t, Index u) { return triangles_intersect(with_points(t), with_points(u)); }))
    out.emplace_back(f, g);
  return out;
}

}  // namespace tetwright

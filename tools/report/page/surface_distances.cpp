// SPDX-License-Identifier: Apache-2.0
#include "tools/report/page/surface_distances.h"

#include <limits>
#include <utility>

#include "common/geometry/projection_tree.h"
#include "common/parallel/parallel.h"

namespace tetwright {

SurfaceDistances surface_distances(const TetMesh& mesh, const TriangleMesh& surface, std::string from) {
  constexpr std::size_t grain = 1024;
  constexpr double anywhere = std::numeric_limits<double>::infinity();
  std::vector<ProjectionTree::Item> items;
  items.reserve(surface.triangles.size());
  for (const Triangle& t : surface.triangles) items.push_back({t, {}});
  const ProjectionTree tree(surface.points, std::move(items));
  SurfaceDistances out{std::move(from),
                       std::vector<float>(mesh.points.size(), std::numeric_limits<float>::quiet_NaN())};
  std::vector<char> on_interface(mesh.points.size(), 0);
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids) on_interface[p] = 1;
  parallel_for(0, mesh.points.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      if (!on_interface[p]) continue;
      const auto hit = tree.nearest_of(mesh.points[p], anywhere, [](const auto&) { return true; });
      if (hit) out.values[p] = static_cast<float>((hit->point - mesh.points[p]).norm());
    }
  });
  return out;
}

}  // namespace tetwright

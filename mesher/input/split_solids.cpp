// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/split_solids.h"

#include <utility>

namespace tetwright {

std::vector<NamedSurface> split_solids(TriangleMesh surface, const std::string& name) {
  std::vector<NamedSurface> solids;
  if (surface.groups.empty()) {
    solids.push_back({name, std::move(surface)});
    return solids;
  }
  std::vector<std::vector<Index>> triangles(surface.groups.size());
  std::vector<std::size_t> order;
  for (Index t = 0; t < surface.triangles.size(); ++t) {
    const std::size_t group = surface.triangle_groups[t];
    if (triangles[group].empty()) order.push_back(group);
    triangles[group].push_back(t);
  }
  std::vector<Index> number(surface.points.size(), no_index);
  for (const std::size_t group : order) {
    const SurfaceRegion& from = surface.groups[group];
    NamedSurface solid{from.name, {}};
    if (from.name.empty()) solid.name = from ? name + "_" + std::to_string(from.number) : name;
    std::vector<Index> used;
    for (const Index t : triangles[group]) {
      Triangle ids = surface.triangles[t];
      for (Index& p : ids) {
        if (number[p] == no_index) {
          number[p] = static_cast<Index>(used.size());
          used.push_back(p);
          solid.surface.points.push_back(surface.points[p]);
        }
        p = number[p];
      }
      solid.surface.triangles.push_back(ids);
    }
    for (const Index p : used) number[p] = no_index;
    solids.push_back(std::move(solid));
  }
  return solids;
}

}  // namespace tetwright

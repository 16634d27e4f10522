// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/original_surface.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "simplify/tuning/tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

OriginalSurface take_surface(const EditableMesh& mesh, OriginalMesh& original) {
  using Grains = SimplifyTuning::Grains;
  std::map<MaterialTag, RegionId> regions;
  for (std::size_t r = 0; r < mesh.region_count(); ++r)
    regions[mesh.tag(static_cast<RegionId>(r))] = static_cast<RegionId>(r);
  const auto region_of = [&](MaterialTag tag) {
    const auto found = regions.find(tag);
    if (found == regions.end())
      throw UsageError("the mesh has no material " + std::to_string(tag) + ", which its original has");
    return found->second;
  };
  TetMesh from = std::exchange(original.surface, {});
  OriginalSurface surface;
  surface.points = std::move(from.points);
  std::vector<Vec3>& points = surface.points;
  parallel_for(0, points.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) points[p] = mesh.space().to_working(points[p]);
  });
  surface.faces.reserve(from.interfaces.size());
  for (const InterfaceTriangle& t : from.interfaces) {
    if (*std::max_element(t.ids.begin(), t.ids.end()) >= points.size())
      throw UsageError("a triangle of the original refers to a point that does not exist");
    surface.faces.push_back(
        {t.ids, region_of(t.material), t.other ? region_of(*t.other) : outside_id, t.patch});
  }
  return surface;
}

}  // namespace tetwright

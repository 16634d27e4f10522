// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/original_surface.h"

#include <algorithm>
#include <map>
#include <string>

#include "simplify/tuning/tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

OriginalSurface surface_of(const EditableMesh& mesh, const OriginalMesh& original) {
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
  const TetMesh& from = original.surface;
  OriginalSurface surface;
  surface.points.resize(from.points.size());
  parallel_for(0, from.points.size(), Grains::slots, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) surface.points[p] = mesh.space().to_working(from.points[p]);
  });
  surface.faces.reserve(from.interfaces.size());
  for (const InterfaceTriangle& t : from.interfaces) {
    if (*std::max_element(t.ids.begin(), t.ids.end()) >= from.points.size())
      throw UsageError("a triangle of the original refers to a point that does not exist");
    surface.faces.push_back(
        {t.ids, region_of(t.material), t.other ? region_of(*t.other) : outside_id, t.patch});
  }
  return surface;
}

}  // namespace tetwright

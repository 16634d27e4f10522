// SPDX-License-Identifier: Apache-2.0
#include "mesher/sheet_faces.h"

#include <algorithm>

#include "tetwright/mesh_quality.h"

namespace tetwright {

std::vector<InterfaceTriangle> sheet_faces(const CutMesh& mesh, const SheetedField& field,
                                           const std::vector<std::uint8_t>& candidates) {
  std::vector<InterfaceTriangle> out;
  for (const MeshFace& f : mesh_faces(mesh.tets, mesh.points.size(), &candidates)) {
    if (f.count != 2) continue;
    const RegionIndex first = mesh.regions[f.first], second = mesh.regions[f.second];
    const std::uint32_t component = first == second ? no_index : field.component_between(first, second);
    if (component == no_index) continue;
    const Tet& behind = mesh.tets[field.part(first).sides.of(component)->in_front ? f.second : f.first];
    for (std::size_t k = 0; k < 4; ++k) {
      if (std::find(f.ids.begin(), f.ids.end(), behind[k]) != f.ids.end()) continue;
      Triangle ids{behind[tet_faces[k][0]], behind[tet_faces[k][1]], behind[tet_faces[k][2]]};
      std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
      const MaterialTag tag = field.regions()[first].tag;
      out.push_back({ids, tag, tag, static_cast<std::uint16_t>(component)});
    }
  }
  return out;
}

std::vector<RegionIndex> regions_without_sheets(const std::vector<RegionIndex>& regions,
                                                const SheetedField& field) {
  std::vector<RegionIndex> out(regions.size());
  for (std::size_t i = 0; i < regions.size(); ++i) out[i] = field.part(regions[i]).region;
  return out;
}

std::vector<std::uint8_t> on_interfaces_without_sheets(const CutMesh& mesh, const SheetedField& field) {
  std::vector<std::uint8_t> on(mesh.points.size(), 0);
  for (const MeshFace& f : mesh_faces(mesh.tets, mesh.points.size(), &mesh.on_interface))
    if (f.count == 1 || field.part(mesh.regions[f.first]).region != field.part(mesh.regions[f.second]).region)
      for (const Index p : f.ids) on[p] = 1;
  return on;
}

}  // namespace tetwright

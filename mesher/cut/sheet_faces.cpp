// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/sheet_faces.h"

#include <algorithm>

#include "tetwright/mesh_quality.h"

namespace tetwright {

std::vector<PartFace> part_faces(const TetMesh& mesh, const SheetParts& parts) {
  // Points with tets of more than one part.
  std::vector<RegionIndex> first(mesh.points.size(), on_interface);
  std::vector<std::uint8_t> candidates(mesh.points.size(), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const Index p : mesh.tets[t]) {
      if (first[p] == on_interface) first[p] = parts.of_tets[t];
      if (first[p] != parts.of_tets[t]) candidates[p] = 1;
    }
  std::vector<PartFace> out;
  for (const MeshFace& f : mesh_faces(mesh.tets, mesh.points.size(), &candidates))
    if (f.count == 2 && parts.of_tets[f.first] != parts.of_tets[f.second])
      out.push_back({f.ids, f.first, f.second});
  return out;
}

std::vector<InterfaceTriangle> sheet_faces(const TetMesh& mesh, const SheetParts& parts) {
  const SheetedField& field = *parts.field;
  std::vector<InterfaceTriangle> out;
  for (const PartFace& f : part_faces(mesh, parts)) {
    const RegionIndex first = parts.of_tets[f.first], second = parts.of_tets[f.second];
    const std::uint32_t component = field.component_between(first, second);
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

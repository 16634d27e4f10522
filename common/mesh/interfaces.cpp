// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <algorithm>

#include "common/mesh/face_collection.h"

namespace tetwright {

namespace {

/// A face of a tet with the normal pointing out, starting at its smallest id.
Triangle outward_face(const Tet& tet, const Triangle& ids) {
  // Valid even if an invalid tet has a repeated vertex.
  const Index opposite = tet[0] ^ tet[1] ^ tet[2] ^ tet[3] ^ ids[0] ^ ids[1] ^ ids[2];
  const auto k = static_cast<std::size_t>(std::find(tet.begin(), tet.end(), opposite) - tet.begin());
  Triangle face{tet[tet_faces[k][0]], tet[tet_faces[k][1]], tet[tet_faces[k][2]]};
  std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  return face;
}

}  // namespace

std::vector<InterfaceTriangle> find_interfaces(const TetMesh& mesh,
                                               const std::vector<std::uint8_t>* candidates) {
  return collect_from_faces<InterfaceTriangle>(
      mesh.tets, mesh.points.size(), candidates,
      [&](const Triangle& vertices, Index first, Index second, std::size_t count,
          std::vector<InterfaceTriangle>& out) {
        const MaterialTag tag = mesh.materials[first];
        if (count == 1) {
          out.push_back({outward_face(mesh.tets[first], vertices), tag, std::nullopt});
        } else if (count == 2 && tag != mesh.materials[second]) {
          const MaterialTag other = mesh.materials[second];
          const Index smaller = tag < other ? first : second;
          out.push_back(
              {outward_face(mesh.tets[smaller], vertices), std::min(tag, other), std::max(tag, other)});
        }
      });
}

std::vector<MaterialPair> interface_groups(const std::vector<InterfaceTriangle>& triangles) {
  std::vector<MaterialPair> groups;
  for (const InterfaceTriangle& t : triangles) {
    const MaterialPair pair = t.pair();
    const auto at = std::lower_bound(groups.begin(), groups.end(), pair);
    if (at == groups.end() || *at != pair) groups.insert(at, pair);
  }
  return groups;
}

std::string pair_name(const MaterialPair& pair, const std::map<MaterialTag, std::string>& names) {
  const auto name = [&](MaterialTag tag) {
    const auto at = names.find(tag);
    return at == names.end() ? std::to_string(tag) : at->second;
  };
  return name(pair.first) + "|" + (pair.second ? name(*pair.second) : "outside");
}

}  // namespace tetwright

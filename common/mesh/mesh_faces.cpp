// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/face_collection.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

std::vector<MeshFace> mesh_faces(std::span<const Tet> tets, std::size_t points,
                                 const std::vector<std::uint8_t>* candidates) {
  return collect_from_faces<MeshFace>(
      tets, points, candidates,
      [](const Triangle& vertices, Index first, Index second, std::size_t count, std::vector<MeshFace>& out) {
        out.push_back({vertices, first, second, static_cast<std::uint32_t>(count)});
      });
}

}  // namespace tetwright

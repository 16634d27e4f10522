// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/io/contents/mesh_to_write.h"
#include "common/mesh/interfaces.h"
#include "common/mesh/midside_nodes.h"
#include "tests/common/small_meshes.h"

namespace tetwright {

/// Two named materials, -7 and 1, with listed faces; one boundary face of material 1 belongs to a region of
/// the input.
inline TetMesh mesh_with_surfaces() {
  TetMesh mesh = two_tets(-7);
  mesh.points[1] = {1.0 / 3, 1e-7, -2.0 / 3};
  mesh.material_names = {{1, "bone"}, {-7, "skin"}};
  mesh.interfaces = find_interfaces(mesh);
  for (InterfaceTriangle& t : mesh.interfaces)
    if (t.material == 1 && !t.other) {
      t.patch = 1;
      mesh.patch_groups = {{{t.pair(), 1}, {5, "outlet"}}};
      break;
    }
  return mesh;
}

inline std::string text_of(void (*write)(const MeshToWrite&, const ByteSink&), const MeshToWrite& mesh) {
  std::string out;
  write(mesh, [&](std::string_view bytes) { out += bytes; });
  return out;
}

}  // namespace tetwright

#pragma once

#include <string>

#include "common/tet_mesh.h"

namespace tetwright {

/// What a reader of tet meshes found.
struct ReadTetMesh {
  TetMesh mesh;
  /// The cell field that was taken for the material: "material", "medit:ref", "gmsh:physical", "MaterialID",
  /// "attribute" or the file's only integer cell field. Empty if there is none: every tet has material 1.
  std::string material_field;
};

}  // namespace tetwright

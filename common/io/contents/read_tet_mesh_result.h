// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// Options of the readers of tet meshes.
struct ReadTetMeshOptions {
  /// The name of the cell field to take as the material instead of the one that ReadTetMesh::material_field
  /// describes. Empty: none is asked for. If the file has no such field, an InputError lists those it has.
  std::string material_field;
  /// False: a file without that field is read as if none had been asked for.
  bool material_field_required = true;
};

/// The result of a reader of tet meshes.
struct ReadTetMesh {
  TetMesh mesh;
  /// The cell field that became mesh.materials; it is removed from mesh.cell_fields. It is the first of these
  /// that the file has:
  /// 1. the field that the options ask for;
  /// 2. the format's own: "medit:ref", "gmsh:physical" or, in a .msh file without physical groups,
  ///    "gmsh:geometrical";
  /// 3. "material", "medit:ref", "gmsh:physical", "MaterialID", "attribute", in this order;
  /// 4. the only integer cell field.
  /// Empty: the file has none of them, and every tet has material 1.
  std::string material_field = {};
  /// What the file holds beside this, by kind. Volume cells that are not linear tets are never among it: a
  /// file that has some is refused.
  std::vector<Dropped> dropped = {};
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// Options of the readers of tet meshes.
struct ReadTetMeshOptions {
  /// Cell field to use as the material instead of the one that ReadTetMesh::material_field describes; empty:
  /// the default. If the file has no such field, an InputError lists its fields.
  std::string material_field;
  /// False: a file without that field is read with the default.
  bool material_field_required = true;
};

/// The result of a reader of tet meshes.
struct ReadTetMesh {
  TetMesh mesh;
  /// Cell field that became mesh.materials; it is removed from mesh.cell_fields. The first of these that the
  /// file has:
  /// 1. the field that the options request;
  /// 2. the format's own: "medit:ref", "gmsh:physical" or, in a .msh file without physical groups,
  ///   "gmsh:geometrical";
  /// 3. "material", "medit:ref", "gmsh:physical", "MaterialID", "attribute", in this order;
  /// 4. the only integer cell field.
  ///
  /// Empty: the file has none of them, and every tet has material 1.
  std::string material_field = {};
  /// Other contents of the file, by kind. Volume cells that are not linear tets are never among them: such a
  /// file is rejected.
  std::vector<Dropped> dropped = {};
};

}  // namespace tetwright

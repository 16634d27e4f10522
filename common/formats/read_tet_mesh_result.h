#pragma once

#include <string>

#include "common/tet_mesh.h"

namespace tetwright {

/// What a reader of tet meshes is asked for.
struct ReadTetMeshOptions {
  /// The cell field that is the material, whatever the rule of ReadTetMesh says. Empty: by that rule. A name
  /// that the file does not have is an InputError that lists those it could be.
  std::string material_field;
  /// False: a file without that field is read by the rule instead.
  bool material_field_required = true;
};

/// What a reader of tet meshes found.
struct ReadTetMesh {
  TetMesh mesh;
  /// The cell field that was taken for the material, and that mesh.cell_fields so has no more: the one asked
  /// for, else the format's own ("medit:ref", "gmsh:physical" or, in a file without physical groups,
  /// "gmsh:geometrical"), else the first of "material", "medit:ref", "gmsh:physical", "MaterialID" and
  /// "attribute", else the file's only integer cell field. Empty if there is none: every tet has material 1.
  std::string material_field;
};

}  // namespace tetwright

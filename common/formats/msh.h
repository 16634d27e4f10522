#pragma once

#include <string>
#include <string_view>

#include "common/formats/read_tet_mesh_result.h"

namespace tetwright {

/// Reads the tets (type 4) of a Gmsh MSH file of version 2, ASCII; the physical group is the material, its
/// name that of $PhysicalNames. Other elements, names and sections are skipped. `name` stands in messages.
/// Throws InputError with the line for anything that makes no sense; other versions and binary files are
/// refused with what to do.
ReadTetMesh read_msh(std::string_view bytes, const std::string& name);

/// The file's content, version 2.2 ASCII; coordinates come back bit by bit. Interface triangles, where the
/// mesh has them, follow the tets; each pair of materials is a physical group of dimension 2, numbered as
/// interface_groups() does and named as pair_name() does. A quote or control character in a name becomes an
/// underscore.
std::string write_msh(const TetMesh& mesh);

}  // namespace tetwright

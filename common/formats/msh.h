#pragma once

#include <string>
#include <string_view>

#include "common/formats/read_tet_mesh_result.h"

namespace tetwright {

/// Reads the tets (type 4) of a Gmsh MSH file of version 2 or 4.1, ASCII. The material is the (first)
/// physical group, with its name from $PhysicalNames; in version 4.1, where no volume has one, the volume's
/// own number
/// ("gmsh:geometrical", which can also be asked for). Points, lines and faces are skipped, other volume
/// elements refused. $NodeData and $ElementData become fields, nan where a section names no value;
/// unknown sections are skipped. `name` stands in messages. Throws InputError with the line for anything that
/// makes no sense; other versions, binary files and partitioned meshes are refused with what to do.
ReadTetMesh read_msh(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options = {});

/// The file's content, version 2.2 ASCII; coordinates come back bit by bit. Interface triangles, where the
/// mesh has them, follow the tets; each pair of materials is a physical group of dimension 2, numbered as
/// interface_groups() does and named as pair_name() does. Fields follow as $NodeData and $ElementData, see
/// append_msh_data(). A quote or control character in a name becomes an underscore.
std::string write_msh(const TetMesh& mesh);

}  // namespace tetwright

#pragma once

#include <string>
#include <string_view>

#include "common/formats/read_tet_mesh_result.h"

namespace tetwright {

/// Reads the sections Vertices and Tetrahedra of a Medit ASCII mesh (.mesh). The reference of a tet is its
/// material ("medit:ref"); the format has no place for fields. Sections of other volume cells are refused,
/// what other sections hold is counted in ReadTetMesh::dropped. `name` is used in messages. Throws InputError
/// with the line for anything that is malformed.
///
/// Our own: libMeshb reports that a file can't be read without saying where and why.
ReadTetMesh read_medit(std::string_view bytes, const std::string& name,
                       const ReadTetMeshOptions& options = {});

/// The content of a file; coordinates are read back bit by bit. The format has no place for fields and for
/// names of materials. The interface triangles of the mesh, if it has any, are written as section Triangles:
/// their reference is the number of the pair of materials (see interface_groups()), and a comment gives the
/// tags of each pair.
std::string write_medit(const TetMesh& mesh);

}  // namespace tetwright

#pragma once

#include <string>
#include <string_view>

#include "common/formats/read_tet_mesh_result.h"

namespace tetwright {

/// Reads the sections Vertices and Tetrahedra of a Medit ASCII mesh (.mesh); the reference of a tet is its
/// material ("medit:ref"). Other sections are skipped; the format has no place for fields. `name` stands in
/// messages. Throws InputError with the line for anything that makes no sense.
ReadTetMesh read_medit(std::string_view bytes, const std::string& name,
                       const ReadTetMeshOptions& options = {});

/// The file's content; coordinates come back bit by bit. Names of materials and fields have no place in the
/// format.
/// Interface triangles, where the mesh has them, make the section Triangles; the reference is the number of
/// the pair of materials, see interface_groups(), and a comment gives the tags of each pair.
std::string write_medit(const TetMesh& mesh);

}  // namespace tetwright

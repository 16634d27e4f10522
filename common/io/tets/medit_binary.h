// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/io/contents/mesh_to_write.h"
#include "common/io/contents/read_tet_mesh_result.h"

namespace tetwright {

/// Reads the vertices and tets of a binary Medit mesh (.meshb) of version 1 to 4 and either byte order, with
/// references of tets as materials ("medit:ref") and of triangles as groups of faces, as read_medit() does.
/// Sections of other volume cells are rejected, contents of other sections are counted in
/// ReadTetMesh::dropped.
///
/// Not a library: libMeshb is not packaged.
/// \throws InputError with the byte for malformed contents
ReadTetMesh read_medit_binary(std::string_view bytes, const std::string& name,
                              const ReadTetMeshOptions& options = {});

/// Writes a binary Medit mesh (.meshb), little-endian, of version 2, or of version 3 beyond 2 GB. Contents as
/// in write_medit(), without comments, which the format lacks: references are numbers only.
void write_medit_binary(const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright

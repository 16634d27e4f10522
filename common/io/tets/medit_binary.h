// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "common/io/contents/mesh_to_write.h"
#include "common/io/contents/read_tet_mesh_result.h"

namespace tetwright {

/// Reads the vertices and tets of a binary Medit mesh (.meshb) of version 1 to 4 and either byte order, with
/// the references of tets as materials ("medit:ref") and of triangles as groups of faces, as read_medit()
/// does. Sections of other volume cells are refused, what other sections hold is counted in
/// ReadTetMesh::dropped. Throws InputError with the byte for anything that is malformed.
///
/// Our own: libMeshb is not packaged.
ReadTetMesh read_medit_binary(std::string_view bytes, const std::string& name,
                              const ReadTetMeshOptions& options = {});

/// The content of a binary Medit mesh (.meshb), little-endian, of version 2, or of version 3 if it is beyond
/// 2 GB: what write_medit() writes, without its comments, for which there is no place: references are numbers
/// only.
void write_medit_binary(const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright

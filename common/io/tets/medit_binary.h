// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "tetwright/io.h"

namespace tetwright {

/// Reads the vertices and tets of a binary Medit mesh (.meshb) of versions 1 to 4 and either byte order.
/// References of tets are materials ("medit:ref"), those of triangles are groups of faces, as for
/// read_medit(). Sections of other volume cells are rejected; contents of other sections are counted in
/// ReadTetMesh::dropped.
///
/// No library is used: libMeshb is not packaged.
/// \throws InputError with the byte for malformed contents
ReadTetMesh read_medit_binary(std::string_view bytes, const std::string& name,
                              const ReadTetMeshOptions& options = {});

/// Writes a binary Medit mesh (.meshb), little-endian, version 2, or version 3 beyond 2 GB. The contents are
/// those of write_medit() without comments, which the format does not have: references are numbers only.
void write_medit_binary(const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright

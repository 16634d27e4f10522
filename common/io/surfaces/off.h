// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tetwright/io.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Reads a surface in the Object File Format, ASCII: OFF with or without colours, normals and texture
/// coordinates (COFF, NOFF, STOFF, ...), with or without its keyword. Polygons become fans of triangles. 4-
/// and n-dimensional and binary variants are rejected.
///
/// No library is used: the format is small, and every message names the line and the value.
/// \param name file name for messages
/// \param dropped receives the dropped contents; may be null
/// \throws InputError with the line for malformed contents
TriangleMesh read_off(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

/// Content of a file; coordinates round-trip bit by bit. Groups are not written, since the format has none.
std::string write_off(const TriangleMesh& mesh);

}  // namespace tetwright

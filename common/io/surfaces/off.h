// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Reads a surface in the Object File Format, ASCII: OFF with or without colours, normals and texture
/// coordinates (COFF, NOFF, STOFF, ...), with or without its keyword. Polygons become fans of triangles; what
/// is left out is appended to `dropped`, unless that is null. 4- and n-dimensional and binary variants are
/// refused. `name` is used in messages. Throws InputError with the line for anything that is malformed.
///
/// Our own, since the format is small and every message names the line and the value.
TriangleMesh read_off(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

/// The content of a file; coordinates are read back bit by bit. The format has no groups.
std::string write_off(const TriangleMesh& mesh);

}  // namespace tetwright

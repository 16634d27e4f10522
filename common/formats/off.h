#pragma once

#include <string>
#include <string_view>

#include "common/triangle_mesh.h"

namespace tetwright {

/// Reads a surface in the Object File Format, ASCII: OFF with or without colours, normals and texture
/// coordinates (COFF, NOFF, STOFF, ...; they are left out), with or without its keyword. Polygons become fans
/// of triangles. 4- and n-dimensional and binary variants are refused. `name` stands in messages.
/// Throws InputError with the line for anything that makes no sense.
TriangleMesh read_off(std::string_view bytes, const std::string& name);

/// The file's content; coordinates come back bit by bit.
std::string write_off(const TriangleMesh& mesh);

}  // namespace tetwright

#pragma once

#include <string>
#include <string_view>

#include "common/triangle_mesh.h"

namespace tetwright {

/// Reads the surface of a PLY file, ASCII or binary of either byte order: x, y, z of element `vertex` and
/// `vertex_indices` (or `vertex_index`) of element `face`; other elements and properties are skipped.
/// Polygons become fans of triangles. `name` stands in messages. Throws InputError with the line (ASCII,
/// header) or the byte offset (binary) for anything that makes no sense.
TriangleMesh read_ply(std::string_view bytes, const std::string& name);

/// The file's content, binary little endian with 64-bit coordinates, which come back bit by bit.
std::string write_ply(const TriangleMesh& mesh);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tetwright/io.h"

namespace tetwright {

/// Reads the surface of a PLY file, ASCII or binary of either byte order: x, y, z of element `vertex` and
/// `vertex_indices` (or `vertex_index`) of element `face`. Polygons become fans of triangles.
///
/// No library is used: the format is small, and counts are compared with the bytes available before memory is
/// allocated.
/// \param name file name for messages
/// \param dropped receives other elements and properties; may be null
/// \throws InputError with the line (ASCII, header) or the byte offset (binary) for malformed contents
TriangleMesh read_ply(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

/// Reads the surface, and the other properties of element `vertex` except lists as point fields, by their
/// names. Their values may be NaN or infinite.
SurfaceWithFields read_ply_with_fields(std::string_view bytes, const std::string& name);

/// Content of a file: binary little-endian with 64-bit coordinates, which round-trip bit by bit. The face
/// property "surface" holds the number of the group, from 1, and comments give the groups' names.
std::string write_ply(const TriangleMesh& mesh);

}  // namespace tetwright

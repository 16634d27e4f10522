// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/io/contents/surface_with_fields.h"

namespace tetwright {

/// Reads the surface of a PLY file, ASCII or binary of either byte order: x, y, z of element `vertex` and
/// `vertex_indices` (or `vertex_index`) of element `face`. Polygons become fans of triangles; other elements
/// and properties are appended to `dropped`, unless that is null. `name` is used in messages. Throws
/// InputError with the line (ASCII, header) or the byte offset (binary) for anything that is malformed.
///
/// Our own, since the format is small, and counts are compared with the bytes that are there before memory is
/// allocated.
TriangleMesh read_ply(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

/// The same with the other properties of element `vertex` that are no lists, by their names; they may be nan
/// or infinite.
SurfaceWithFields read_ply_with_fields(std::string_view bytes, const std::string& name);

/// The content of a file, binary little endian with 64-bit coordinates, which are read back bit by bit. The
/// face property "surface" numbers the groups from 1, and comments give their names.
std::string write_ply(const TriangleMesh& mesh);

}  // namespace tetwright

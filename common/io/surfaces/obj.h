// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Reads the surface of a Wavefront OBJ file: `v` and `f` (with /vt/vn, negative indices, continued lines).
/// Polygons become fans of triangles.
///
/// Not a library: the format is small, and every message names the line and the value.
/// \param name used in messages
/// \param dropped receives the contents of other statements; may be null
/// \throws InputError with the line for malformed contents
TriangleMesh read_obj(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

/// Content of a file; coordinates round-trip bit by bit. Groups are `g` statements with their names or
/// numbers, in which white space becomes underscores.
std::string write_obj(const TriangleMesh& mesh);

}  // namespace tetwright

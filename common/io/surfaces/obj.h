// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tetwright/io.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Reads the surface of a Wavefront OBJ file: `v` and `f` (with /vt/vn, negative indices, continued lines).
/// Polygons become fans of triangles.
///
/// No library is used: the format is small, and every message names the line and the value.
/// \param name file name for messages
/// \param dropped receives the contents of other statements; may be null
/// \throws InputError with the line for malformed contents
TriangleMesh read_obj(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

/// Content of a file; coordinates round-trip bit by bit. Groups become `g` statements with their names, in
/// which underscores replace white space, or their numbers.
std::string write_obj(const TriangleMesh& mesh);

}  // namespace tetwright

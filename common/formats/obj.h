#pragma once

#include <string>
#include <string_view>

#include "common/triangle_mesh.h"

namespace tetwright {

/// Reads the surface of a Wavefront OBJ file: `v` and `f` (with /vt/vn, negative indices, continued lines);
/// everything else is skipped. Polygons become fans of triangles. `name` stands in messages.
/// Throws InputError with the line for anything that makes no sense.
TriangleMesh read_obj(std::string_view bytes, const std::string& name);

/// The file's content; coordinates come back bit by bit.
std::string write_obj(const TriangleMesh& mesh);

}  // namespace tetwright

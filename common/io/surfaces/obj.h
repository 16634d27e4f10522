// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Reads the surface of a Wavefront OBJ file: `v` and `f` (with /vt/vn, negative indices, continued lines);
/// what other statements hold is appended to `dropped`, unless that is null. Polygons become fans of
/// triangles. `name` is used in messages. Throws InputError with the line for anything that is malformed.
///
/// Our own, since the format is small and every message names the line and the value.
TriangleMesh read_obj(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

/// The content of a file; coordinates are read back bit by bit. Groups are statements `g` with their names,
/// or numbers, in which white space becomes underscores.
std::string write_obj(const TriangleMesh& mesh);

}  // namespace tetwright

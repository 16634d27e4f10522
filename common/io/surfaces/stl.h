// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Reads an STL file, ASCII or binary (a binary file may begin with "solid": its size tells). Points with
/// equal coordinates become one, nothing else is merged. What is left out is appended to `dropped`, unless
/// that is null. `name` is used in messages. Throws InputError with the line or byte offset for anything that
/// is malformed.
///
/// Our own, since the format is small and every message names the line or byte and the value.
TriangleMesh read_stl(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

/// The content of a file: ASCII, since binary STL has only 32 bits for a coordinate. Coordinates are read
/// back bit by bit, except that -0 becomes 0. Each group is a solid of its name, or number, in which white
/// space becomes underscores; the triangles are sorted by them.
std::string write_stl(const TriangleMesh& mesh);

}  // namespace tetwright

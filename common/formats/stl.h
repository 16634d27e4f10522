#pragma once

#include <string>
#include <string_view>

#include "common/triangle_mesh.h"

namespace tetwright {

/// Reads an STL file, ASCII or binary (a binary file may begin with "solid": its size tells). Points with
/// equal coordinates become one, nothing else is merged. `name` stands in messages. Throws InputError with
/// the line or byte offset for anything that makes no sense.
TriangleMesh read_stl(std::string_view bytes, const std::string& name);

/// The file's content: ASCII, since binary STL has only 32 bits for a coordinate; coordinates come back bit
/// by bit (a -0 as 0).
std::string write_stl(const TriangleMesh& mesh);

}  // namespace tetwright

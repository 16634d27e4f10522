// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tetwright/io.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Reads an STL file, ASCII or binary. A binary file may begin with "solid"; its size decides. Points with
/// equal coordinates are merged; nothing else is changed.
///
/// No library is used: the format is small, and every message names the line or byte and the value.
/// \param name file name for messages
/// \param dropped receives the dropped contents; may be null
/// \throws InputError with the line or byte offset for malformed contents
TriangleMesh read_stl(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

/// Content of a file: ASCII, since binary STL has only 32 bits for a coordinate. Coordinates round-trip bit
/// by bit, except that -0 becomes 0. Each group is a solid with the group's name, in which underscores
/// replace white space, or number; the triangles are sorted by group.
std::string write_stl(const TriangleMesh& mesh);

}  // namespace tetwright

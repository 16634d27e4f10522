// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Reads what a 3D Manufacturing Format file (.3mf, core specification 1.3) builds: its objects with their
/// components, placed by the transforms of both, also where the production extension spreads them over
/// several parts of the file. Coordinates stay in the file's unit. The objects are the groups, by their names
/// or those of objects that they are parts of; of several objects with one name the later ones are called
/// NAME_2, NAME_3 and so on. Objects that are there only to support others while they are printed or are no
/// meshes, colours, materials and beam lattices are left out and appended to `dropped`, unless that is null.
/// `name` is used in messages. Throws InputError with the part of the file and the line for anything that is
/// malformed, and for extensions that change the shape.
///
/// On libzip and pugixml: Assimp crashes on most damaged files, and Debian's lib3mf (1.8) has no place for
/// objects in other parts.
TriangleMesh read_3mf(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

}  // namespace tetwright

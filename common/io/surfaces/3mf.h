// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Reads the build of a 3D Manufacturing Format file (.3mf, core specification 1.3): its objects with their
/// components, placed by the transforms of both, also where the production extension distributes them over
/// several parts of the file. Coordinates stay in the file's unit. Groups are the objects, by their names or
/// those of objects that contain them; repeated names become NAME_2, NAME_3 and so on. Objects that only
/// support others during printing or are no meshes, colours, materials and beam lattices are dropped.
///
/// Uses libzip and pugixml: Assimp crashes on most damaged files, and Debian's lib3mf (1.8) does not support
/// objects in other parts.
/// \param name used in messages
/// \param dropped receives the dropped contents; may be null
/// \throws InputError with the part of the file and the line for malformed contents, and for extensions that
///   change the shape
TriangleMesh read_3mf(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

}  // namespace tetwright

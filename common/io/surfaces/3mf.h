// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tetwright/io.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Reads the build of a 3D Manufacturing Format file (.3mf, core specification 1.3): its objects and their
/// components, placed by the transforms of both. The production extension, which distributes objects over
/// several parts of the file, is supported. Coordinates stay in the file's unit. Each object is a group with
/// its name or that of an object that contains it; repeated names become NAME_2, NAME_3 and so on. Colours,
/// materials, beam lattices, and objects that are not meshes or only support others during printing are
/// dropped.
///
/// Uses libzip and pugixml: Assimp crashes on most damaged files, and Debian's lib3mf (1.8) does not support
/// objects in other parts.
/// \param name file name for messages
/// \param dropped receives the dropped contents; may be null
/// \throws InputError with the part of the file and the line for malformed contents, and for extensions that
///   change the shape
TriangleMesh read_3mf(std::string_view bytes, const std::string& name,
                      std::vector<Dropped>* dropped = nullptr);

}  // namespace tetwright

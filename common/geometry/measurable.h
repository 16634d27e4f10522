// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/tet_mesh.h"

namespace tetwright {

/// Checks that areas and volumes, which involve squares and cubes of coordinates, neither overflow nor
/// vanish.
/// \param longest_side of the bounding box, input units
/// \param largest_coordinate maximum absolute value of a coordinate, input units
/// \param what "surface" or "mesh"
/// \param file named in messages
/// \throws InputError if they would
void require_measurable(double longest_side, double largest_coordinate, const char* what,
                        const std::string& file);

/// Checks the tets and points of a mesh.
/// \pre indices in range
void require_measurable(const TetMesh& mesh, const std::string& file);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Checks that areas and volumes, which involve squares and cubes of coordinates, neither overflow nor
/// underflow to 0.
/// \param longest_side longest side of the bounding box, input units
/// \param largest_coordinate maximum absolute value of a coordinate, input units
/// \param what "surface" or "mesh"
/// \param file file name for messages
/// \throws InputError if a coordinate or the size is out of range
void require_measurable(double longest_side, double largest_coordinate, const char* what,
                        const std::string& file);

/// Checks the tets and points of a mesh.
/// \pre indices in range
void require_measurable(const TetMesh& mesh, const std::string& file);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/tet_mesh.h"

namespace tetwright {

/// Throws InputError for `what` ("surface", "mesh") of `file` if areas and volumes, which take squares and
/// cubes of coordinates, would overflow or vanish. Both in input units: the longest side of its box, and the
/// largest absolute value of a coordinate.
void require_measurable(double longest_side, double largest_coordinate, const char* what,
                        const std::string& file);

/// The same for the tets and points of a mesh, whose indices must be in range.
void require_measurable(const TetMesh& mesh, const std::string& file);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The min angle between two planes, radians, that admits a tet with an edge on their intersection and solid
/// angles of at least `solid_angle`. The optimal tet is symmetric to both planes.
///
/// \param solid_angle steradians, at most the regular tet's
double narrowest_wedge(double solid_angle);

/// Number of tets below a solid angle that angles of the input force to be: they have an edge on a crease
/// where the material's angle is below narrowest_wedge(), or a vertex at a corner where its solid angle is
/// below `threshold`. Linear in the number of tets.
///
/// \param creases of the input
/// \param threshold solid angle, steradians
/// \pre All ids are in range.
std::size_t input_limited_tets(const TetMesh& mesh, const CreaseCurves& creases, double threshold);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Minimum angle between two planes, radians, that admits a tet with an edge on their intersection and solid
/// angles of at least `solid_angle`. The optimal tet is symmetric with respect to both planes.
///
/// \param solid_angle steradians, at most the regular tet's
double narrowest_wedge(double solid_angle);

/// Number of tets below a solid angle that are forced to be so by angles of the input. Such a tet has an edge
/// on a crease where the material's angle is below narrowest_wedge(), or a vertex at a corner where the
/// material's solid angle is below `threshold`. Linear in the number of tets.
///
/// \param creases creases of the input
/// \param threshold solid angle, steradians
/// \pre All ids are in range.
std::size_t input_limited_tets(const TetMesh& mesh, const CreaseCurves& creases, double threshold);

}  // namespace tetwright

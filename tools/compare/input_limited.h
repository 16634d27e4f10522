// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/features/surface_patches.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// The narrowest wedge between two planes, radians, in which a tet with an edge where they meet can have
/// solid angles of at least `solid_angle` (steradians, up to the regular tet's): one that is symmetric to
/// both.
double narrowest_wedge(double solid_angle);

/// Tets with a smaller solid angle than `threshold` (steradians) that cannot have a larger one, since angles
/// of the input leave no room: with an edge on a crease along which the material is narrower than
/// narrowest_wedge(), or a vertex at a corner where the material has less than `threshold`. `creases` are
/// those of the input; ids must be in range. One look at every tet, where any is below.
std::size_t input_limited_tets(const TetMesh& mesh, const CreaseCurves& creases, double threshold);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Moves points back to `before` until no two `faces`, the boundary and interfaces of the tets, intersect.
/// Quality bounds on tets cannot prevent intersections through the outside, which has no tets. If moving back
/// would invert a tet, all its points are moved back. Faces that intersected in `before` may intersect again.
/// The result does not depend on the number of threads.
void undo_intersections(std::vector<Vec3>& points, const std::vector<Tet>& tets,
                        const std::vector<Triangle>& faces, const std::vector<Vec3>& before);

}  // namespace tetwright

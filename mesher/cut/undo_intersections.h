// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/types.h"

namespace tetwright {

/// Moves points back to `before` until no two `faces`, the boundary and interfaces of the tets, intersect.
/// Tets guard their own shapes when points move, but the outside has none that could invert. A tet that this
/// would invert has all its points moved back too. Faces that intersected before do so again. The result does
/// not depend on the number of threads.
void undo_intersections(std::vector<Vec3>& points, const std::vector<Tet>& tets,
                        const std::vector<Triangle>& faces, const std::vector<Vec3>& before);

}  // namespace tetwright

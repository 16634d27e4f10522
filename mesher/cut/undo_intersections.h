// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/types.h"

namespace tetwright {

/// Puts points back to where they were `before` until no two `faces`, the boundary and interfaces of the
/// tets, intersect: tets keep shapes of their own when points move, but the outside has none that would be
/// turned over. With points goes what would invert a tet. Where faces intersected before, they do so again.
/// The same result for any number of threads.
void undo_intersections(std::vector<Vec3>& points, const std::vector<Tet>& tets,
                        const std::vector<Triangle>& faces, const std::vector<Vec3>& before);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "mesher/input/surface_components.h"
#include "tetwright/mesher_input.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The treatment of each component.
struct ArrangedComponents {
  std::vector<char> turn;       ///< 1: to be reversed
  std::vector<char> redundant;  ///< 1: closed, no effect on the solid, no intersections: to be omitted
  std::vector<Index>
      nested;  ///< with NestedRule::material the components that become materials, outermost first
};

/// Determines which components contain which others, and the orientation of each.
///
/// A component contains another if the two do not intersect and one point of the other is inside. For closed
/// components the test is exact, by the crossings of a vertical line; for open ones the winding number must
/// be at least 1/2 in absolute value.
///
/// The orientation of a component is the sign of its volume. For an open one the volume is the sum of the
/// cones of its triangles and depends on the apex; the orientation is defined if the sign is the same for
/// every apex in the component's bounding box. Otherwise it is unclear, and the component is reversed only
/// together with its encloser.
///
/// Cost: O(n log n), plus for each component the triangles that a vertical line meets.
/// \param crossing pairs of triangles that intersect, by number
ArrangedComponents arrange_components(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                                      const std::vector<SurfaceComponent>& components,
                                      const std::vector<std::pair<Index, Index>>& crossing, NestedRule nested,
                                      std::vector<Diagnostic>& findings);

}  // namespace tetwright

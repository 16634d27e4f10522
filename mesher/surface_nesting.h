#pragma once

#include <utility>
#include <vector>

#include "common/types.h"
#include "mesher/surface_components.h"
#include "mesher/surface_input.h"

namespace tetwright {

/// What is to be done with each component.
struct ArrangedComponents {
  std::vector<char> turn;       ///< to be turned over
  std::vector<char> redundant;  ///< closed, changes nothing of the solid, met by no other one: to be left out
  std::vector<Index> nested;    ///< with NestedRule::material those that become materials, outermost first
};

/// Decides which components enclose which, and how each is to be wound.
///
/// A component encloses another one where they do not intersect and one point of the other is inside:
/// exactly, by the crossings of a vertical line, for closed ones; where the winding number is at least 1/2 in
/// size for open ones.
///
/// A component's own winding is the sign of its volume. That of an open one is the sum of its triangles'
/// cones and depends on the apex: it counts where it has the same sign from everywhere in the component's
/// bounding box. Elsewhere the winding is unclear, and the component is turned over with its encloser only.
///
/// `crossing`: pairs of triangles that intersect, by number. Cost: O(n log n), and for each component those
/// triangles that a vertical line meets.
ArrangedComponents arrange_components(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                                      const std::vector<SurfaceComponent>& components,
                                      const std::vector<std::pair<Index, Index>>& crossing, NestedRule nested,
                                      std::vector<SurfaceFinding>& findings);

}  // namespace tetwright

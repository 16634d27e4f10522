#pragma once

#include <cmath>
#include <compare>
#include <functional>
#include <vector>

#include "common/morton.h"
#include "common/progress.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// From this generalised winding number on a point is inside: half, and a little more than rounding on top,
/// so that the back of a flat sheet is not inside here and there.
inline constexpr double inside_winding = 0.5001;

/// What is known of a grid point.
struct GridReading {
  double distance = 0;  ///< from the surface, finest cells, negative inside, cut off at the band
  double winding = 0;   ///< generalised winding number
};

/// The edge of a finest cell from a grid point one cell up along an axis.
struct GridEdge {
  MortonKey lower;
  int axis;
  auto operator<=>(const GridEdge&) const = default;
};

/// True if one end of a grid edge is inside and the other is not, though no surface comes between them: a
/// surface that crosses the edge is within one cell of both ends together.
inline bool needs_cap(double distance, double next_distance) {
  constexpr double slack = 0.02;  // the distances' error near the surface
  return (distance < 0) != (next_distance < 0) && std::abs(distance) + std::abs(next_distance) > 1 + slack;
}

/// Surfaces across the holes of a surface: where the winding number of grid points passes inside_winding
/// without a surface. From the edges in `seeds` (those within the band) on, cap by cap as far as they go;
/// every edge that needs a cap is crossed by one, so there the distances from surface and caps together are
/// one cell or less in all.
///
/// Surface nets (Gibson 1998): a point in each cell at the mean of the places where its edges are crossed, a
/// quadrilateral around each edge that needs a cap, wound with the inside on the back. In grid coordinates.
/// `read` is called concurrently, about once for each grid point within a cell of the caps; seeds must be two
/// cells or more inside the grid and so must be whatever `read` calls inside. Memory and time grow with the
/// caps. The same for any order of `seeds` and any number of threads. Throws Interrupted.
TriangleMesh cap_holes(const std::vector<GridEdge>& seeds,
                       const std::function<GridReading(int, int, int)>& read, Progress* progress);

}  // namespace tetwright

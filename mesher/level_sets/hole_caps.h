// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <compare>
#include <functional>
#include <vector>

#include "common/geometry/morton.h"
#include "mesher/tuning/distance_tuning.h"
#include "tetwright/progress.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Distance and winding number at a grid point.
struct GridReading {
  double distance = 0;  ///< from the surface, voxels, negative inside, clamped to the band
  double winding = 0;   ///< generalised winding number
};

/// The edge of a voxel from a grid point upwards along an axis.
struct GridEdge {
  MortonKey lower;
  int axis;
  auto operator<=>(const GridEdge&) const = default;
};

/// True if exactly one end of a grid edge is inside although no surface crosses the edge. Where a surface
/// crosses it, the distances at both ends add up to at most one voxel.
inline bool needs_cap(double distance, double next_distance) {
  return (distance < 0) != (next_distance < 0) &&
         std::abs(distance) + std::abs(next_distance) > 1 + DistanceTuning::Caps::distance_error;
}

/// Caps the holes of a surface, where the winding number crosses inside_winding without a surface. Starts
/// from the grid edges in `seeds`, which lie within the band, and follows each cap to its end. A cap crosses
/// every edge that needs one, so the distances from surface and caps at its ends add up to at most one voxel.
///
/// Caps are surface nets (Gibson 1998) in grid coordinates: a point in each cell at the mean of the crossings
/// of its edges, and a quadrilateral around each edge that needs a cap, oriented outwards. Memory and time
/// are proportional to the caps. The result depends neither on the order of `seeds` nor on the number of
/// threads.
/// \param read called concurrently, about once for each grid point within a cell of the caps
/// \pre seeds, and all points that `read` reports as inside, are at least two cells inside the grid
/// \throws Interrupted
TriangleMesh cap_holes(const std::vector<GridEdge>& seeds,
                       const std::function<GridReading(int, int, int)>& read, Progress* progress);

}  // namespace tetwright

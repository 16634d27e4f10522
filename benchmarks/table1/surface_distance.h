// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/triangle_mesh.h"

namespace tetwright {

/// Of the bounding box of all points that a triangle has.
double diagonal(const TriangleMesh& surface);

/// Distances of one surface's samples from another surface.
struct OneWayDistance {
  double rms = 0, max = 0;
};

struct SurfaceDistance {
  OneWayDistance to_reference;    ///< from the mesh's boundary to the scan
  OneWayDistance from_reference;  ///< from the scan to the mesh's boundary
};

/// Samples of a surface: each triangle gets samples in proportion to its area, at random places, so that
/// their mean is a mean over the surface (systematic sampling: the running sum of areas is cut into `count`
/// equal parts, one sample in each). The rms is taken over these; the maximum also over all vertices, edge
/// midpoints and centroids. Distances are exact, from the nearest of all triangles of the other surface.
/// Deterministic. In the surfaces' unit.
SurfaceDistance surface_distance(const TriangleMesh& surface, const TriangleMesh& reference,
                                 std::size_t count = 200000);

}  // namespace tetwright

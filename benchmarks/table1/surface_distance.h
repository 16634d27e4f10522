// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Diagonal of the bounding box of all points that a triangle uses.
double diagonal(const TriangleMesh& surface);

/// Distances of the samples of one surface from another surface.
struct OneWayDistance {
  double rms = 0, max = 0;
};

struct SurfaceDistance {
  OneWayDistance to_reference;    ///< from the mesh's boundary to the scan
  OneWayDistance from_reference;  ///< from the scan to the mesh's boundary
};

/// Two-way distance between surfaces, in their unit. Deterministic.
///
/// A surface is sampled at random points, in proportion to the triangles' areas, so that the samples' mean is
/// a mean over the surface. Systematic sampling: the running sum of areas is divided into `count` equal parts
/// with one sample in each. The rms is over these samples; the maximum also includes all vertices, edge
/// midpoints and centroids. Distances from the nearest triangle of the other surface are exact.
SurfaceDistance surface_distance(const TriangleMesh& surface, const TriangleMesh& reference,
                                 std::size_t count = 200000);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// An edge of a set of triangles.
struct SurfaceEdge {
  std::array<Index, 2> ids;  ///< ascending
  std::uint32_t count;       ///< number of its triangles
};

/// Connectivity of a set of triangles, by ids alone.
struct SurfaceChains {
  std::vector<SurfaceEdge> edges;  ///< in lexicographic order
  std::size_t points = 0;          ///< vertices in use
  std::size_t components = 0;      ///< edge-connected components of the triangles
  std::vector<Index>
      touching_points;           ///< points where fans of triangles without a common edge meet, ascending
  std::size_t surplus_fans = 0;  ///< fans around points, beyond the first of each point

  /// Euler characteristic: points - edges + triangles.
  std::ptrdiff_t euler(std::size_t triangles) const {
    return static_cast<std::ptrdiff_t>(points) - static_cast<std::ptrdiff_t>(edges.size()) +
           static_cast<std::ptrdiff_t>(triangles);
  }
};

/// Analyses triangles. O(n log n); about 100 bytes of memory for each triangle.
SurfaceChains surface_chains(std::span<const Triangle> triangles);

}  // namespace tetwright

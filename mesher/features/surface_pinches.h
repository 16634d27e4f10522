// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Edges and points at which surfaces touch themselves.
struct SurfacePinches {
  /// An edge with more than two faces of a surface.
  struct Edge {
    std::array<Index, 2> ends;  ///< ascending
    std::uint32_t surface;
  };
  /// A point at which the faces of a surface form more than one fan.
  struct Point {
    Index point;
    std::uint32_t surface;
    std::vector<Index> beside;  ///< its neighbours in all fans but the one with the most faces, ascending
  };
  std::vector<Edge> edges;    ///< by surface, then ends
  std::vector<Point> points;  ///< by surface, then point
};

/// Finds where surfaces touch themselves. O(n log n).
/// \param surfaces of each face; a face may be given several times, as part of several surfaces
/// \param considers whether a point is to be looked at: then all faces at it must be given
SurfacePinches find_pinches(std::span<const Triangle> faces, std::span<const std::uint32_t> surfaces,
                            const std::function<bool(Index)>& considers);

}  // namespace tetwright

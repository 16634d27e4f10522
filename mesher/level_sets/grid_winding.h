// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The exact winding number of a closed surface at every point of the integer grid: the signed number of
/// crossings of the surface with the vertical line from below. Cavities oriented inwards are outside (0),
/// overlapping parts are inside (2 or more), regardless of self-intersections.
///
/// Memory and time are proportional to the projected area (N^2), not to the grid. Immutable after
/// construction; all functions may be called concurrently.
class GridWinding {
 public:
  /// The winding number is `winding` from the node `first` of a row up to the next entry's.
  struct Crossing {
    std::int32_t first;
    std::int32_t winding;
  };

  /// \param points grid coordinates
  /// \param cells the grid has the nodes 0...cells[a] along each axis a
  GridWinding(std::span<const Vec3> points, std::span<const Triangle> triangles,
              const std::array<int, 3>& cells);

  /// The crossings of the vertical row at (x, y) by ascending `first`; the winding number below the first is
  /// 0. Empty outside the grid.
  std::span<const Crossing> row(int x, int y) const {
    if (x < 0 || y < 0 || x >= nodes_x_ || y >= nodes_y_) return {};
    const std::size_t r =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(nodes_x_) + static_cast<std::size_t>(x);
    return {crossings_.data() + starts_[r], crossings_.data() + starts_[r + 1]};
  }

  std::int32_t at(int x, int y, int z) const {
    std::int32_t winding = 0;
    for (const Crossing& c : row(x, y)) {
      if (c.first > z) break;
      winding = c.winding;
    }
    return winding;
  }
  /// True where the winding number is positive.
  bool inside(int x, int y, int z) const { return at(x, y, z) > 0; }

 private:
  int nodes_x_, nodes_y_;
  std::vector<std::size_t> starts_;
  std::vector<Crossing> crossings_;
};

}  // namespace tetwright

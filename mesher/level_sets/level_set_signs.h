// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "common/geometry/surface_tree.h"
#include "mesher/level_sets/grid_winding.h"
#include "mesher/level_sets/openvdb_grids.h"
#include "tetwright/progress.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// The generalised winding number of a repaired surface at grid points: exact for its closed part, by a tree
/// for its open part. All functions may be called concurrently.
class NodeWinding {
 public:
  /// \param points grid coordinates
  /// \param closed number of triangles of the closed part, which come first
  NodeWinding(std::span<const Vec3> points, std::span<const Triangle> triangles, std::size_t closed,
              const std::array<int, 3>& cells);

  /// True if there is no open part.
  bool whole_numbers() const { return !open_; }
  const GridWinding& closed() const { return closed_; }
  /// At most 1/2 outside the surface's bounding box, where many open parts together could otherwise make an
  /// inside.
  double at(int x, int y, int z) const;

 private:
  GridWinding closed_;
  std::optional<SurfaceTree> open_;
  std::array<int, 3> low_, high_;  ///< the grid points of the bounding box
};

/// Adds signs to the unsigned distances of the band. Adds caps where the inside ends without a surface; the
/// distances then refer to surface and caps together, so that there is an interface wherever the sign
/// changes.
/// \return the caps, in grid coordinates
/// \throws Interrupted
TriangleMesh sign_band(DistanceGrid& grid, const NodeWinding& winding, Progress* progress);

}  // namespace tetwright

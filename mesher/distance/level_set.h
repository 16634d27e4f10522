// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "common/geometry/morton.h"
#include "common/progress.h"
#include "mesher/distance/narrow_band.h"
#include "mesher/distance/openvdb_grids.h"
#include "mesher/distance/thin_walls.h"
#include "mesher/domain/grid_frame.h"
#include "mesher/input/surface_repair.h"

namespace tetwright {

/// A signed distance function on the grid, stored as an OpenVDB volume: negative inside, in voxels, correct
/// within the band and clamped outside it, where only the sign is meaningful.
///
/// A grid point on the surface is consistently classified as inside or outside and never has the value 0.
/// Memory is proportional to the surface (N^2). Immutable after construction; all functions may be called
/// concurrently.
class LevelSet {
 public:
  /// The level set of a surface. Magnitudes come from OpenVDB's unsigned conversion (its signed one would
  /// fill closed cavities), signs at grid points of the band from the exact winding number; points outside
  /// the band take the sign of the band around them. Throws Interrupted.
  static std::shared_ptr<const LevelSet> of_surface(const RepairedSurface& surface, const GridFrame& frame,
                                                    Progress* progress);
  /// The level set of the surface at `depth` voxels (any number > 0) inside: values are the distance plus
  /// `depth`, so what is deeper is inside, with a narrow band around the new zero level. Distances are exact.
  /// Memory is proportional to the new surface. Throws Interrupted.
  static std::shared_ptr<const LevelSet> at_depth(const RepairedSurface& surface, double depth,
                                                  const GridFrame& frame, Progress* progress);
  /// The same, reusing the result of of_surface().
  static std::shared_ptr<const LevelSet> at_depth(const RepairedSurface& surface, const LevelSet& boundary,
                                                  double depth, const GridFrame& frame, Progress* progress);

  /// The same with other distances near thin walls, which are in grid coordinates.
  static std::shared_ptr<const LevelSet> with_walls(const LevelSet& level_set,
                                                    std::shared_ptr<const ThinWalls> walls);
  /// The same with thin walls as thick as they are; gaps that were closed and walls that were left out stay
  /// so. Grid points keep their values. Shares the grid.
  static std::shared_ptr<const LevelSet> with_true_walls(const std::shared_ptr<const LevelSet>& level_set);

  /// Null if there are none.
  const ThinWalls* walls() const { return walls_.get(); }
  const TriangleMesh& caps() const { return *caps_; }
  const DistanceGrid& grid() const { return *grid_; }

  /// The voxels with corners on both sides or with thin walls, as ascending Morton keys of their lower
  /// corners.
  std::vector<MortonKey> interface_cells() const;
  /// The leaves that contain the band, ascending.
  std::vector<LeafOrigin> leaves() const;

 private:
  friend class LevelSetSampler;
  LevelSet(DistanceGrid grid, TriangleMesh caps, const std::array<int, 3>& cells);
  std::shared_ptr<const DistanceGrid> grid_;
  std::shared_ptr<const TriangleMesh> caps_;  ///< what closes the surface's holes, in grid coordinates
  std::array<int, 3> cells_;
  std::shared_ptr<const ThinWalls> walls_;
  bool true_walls_ = false;
};

/// Evaluates a level set, in grid coordinates and voxels. Caches the leaf read last, so evaluating nearby
/// points one after another is fast. Not thread-safe; any number of samplers of one level set may be used
/// concurrently.
class LevelSetSampler {
 public:
  explicit LevelSetSampler(const LevelSet& level_set);

  /// The distance at a grid point, clamped to level_set_band.
  double at_node(int x, int y, int z);
  /// Trilinear interpolation between grid points; near thin walls their distance.
  double at(const Vec3& point);
  /// The same with its gradient (per voxel; of length about 1 within the band).
  double at(const Vec3& point, Vec3& gradient);

 private:
  DistanceGridReader reader_;
  std::array<int, 3> cells_;
  const ThinWalls* walls_;
  bool true_walls_;
};

}  // namespace tetwright

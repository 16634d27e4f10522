// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "common/geometry/morton.h"
#include "mesher/domain/grid_frame.h"
#include "mesher/domain/narrow_band.h"
#include "mesher/level_sets/openvdb_grids.h"
#include "mesher/level_sets/wall_distances.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

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
  /// the band take the sign of the band around them.
  /// \throws Interrupted
  static std::shared_ptr<const LevelSet> of_surface(const RepairedSurface& surface, const GridFrame& frame,
                                                    Progress* progress);
  /// The level set of the offset surface `depth` voxels inside: values are the distance plus `depth`, so that
  /// deeper points are inside, with a narrow band around the new zero level. Distances are exact. Memory is
  /// proportional to the new surface.
  /// \param depth voxels, above 0
  /// \throws Interrupted
  static std::shared_ptr<const LevelSet> at_depth(const RepairedSurface& surface, double depth,
                                                  const GridFrame& frame, Progress* progress);
  /// As above, with the result of of_surface() as `boundary`.
  static std::shared_ptr<const LevelSet> at_depth(const RepairedSurface& surface, const LevelSet& boundary,
                                                  double depth, const GridFrame& frame, Progress* progress);

  /// A copy of a level set whose distances near thin walls come from `walls`, in grid coordinates.
  static std::shared_ptr<const LevelSet> with_walls(const LevelSet& level_set,
                                                    std::shared_ptr<const WallDistances> walls);
  /// The level set with thin walls at their true thickness; closed gaps and omitted walls stay changed. Grid
  /// points keep their values. Shares the grid.
  static std::shared_ptr<const LevelSet> with_true_walls(const std::shared_ptr<const LevelSet>& level_set);

  /// Null if there are no thin walls.
  const WallDistances* walls() const { return walls_.get(); }
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
  std::shared_ptr<const TriangleMesh> caps_;  ///< caps of the surface's holes, in grid coordinates
  std::array<int, 3> cells_;
  std::shared_ptr<const WallDistances> walls_;
  bool true_walls_ = false;
};

/// Evaluates a level set, in grid coordinates and voxels. Caches the last leaf read, so consecutive nearby
/// points are fast, and the last distance near a thin wall, which takes far longer than one elsewhere. Not
/// thread-safe; any number of samplers of one level set may be used concurrently.
class LevelSetSampler {
 public:
  explicit LevelSetSampler(const LevelSet& level_set);

  /// The distance at a grid point, clamped to level_set_band.
  double at_node(int x, int y, int z);
  /// Interpolates trilinearly between grid points; near thin walls returns their distance.
  double at(const Vec3& point);
  /// As above, with the gradient (per voxel; of length about 1 within the band).
  double at(const Vec3& point, Vec3& gradient);

 private:
  DistanceGridReader reader_;
  std::array<int, 3> cells_;
  const WallDistances* walls_;
  bool true_walls_;
  Vec3 last_point_ = Vec3::Constant(HUGE_VAL);  ///< the last one near a wall, with its distance and gradient
  double last_distance_ = 0;
  Vec3 last_gradient_ = Vec3::Zero();
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/geometry/morton.h"
#include "mesher/domain/refinement_regions.h"
#include "mesher/level_sets/level_set.h"
#include "mesher/thin/surface_distance.h"
#include "mesher/thin/thin_walls.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// The thin walls and gaps of one surface, by connected regions of voxels. Measured on the triangles before
/// any cell exists.
struct LocalThickness {
  struct Region {
    /// Predicted dense tets of the region, by the number of halvings allowed where it needs them.
    std::array<double, max_wall_refinement + 1> tets{};
    /// Area in which gaps are too thin, squared voxels, by the number of halvings.
    std::array<double, max_wall_refinement + 1> closed{};
    bool has_walls = true;  ///< walls are thin, too
    int needed = 0;         ///< halvings that would resolve all of it
    int asked = 0;          ///< halvings requested for other reasons
    int depth = 0;          ///< halvings chosen
  };

  std::shared_ptr<const SurfaceDistance> surface;  ///< in voxels; null if nothing is thin
  ThinWalls::Limits limits;
  std::array<int, 3> cells{};         ///< of the frame
  std::vector<MortonKey> voxels;      ///< those with a thin wall or gap, ascending
  std::vector<std::uint32_t> region;  ///< of each voxel in `voxels`
  std::vector<Region> regions;
  std::vector<MortonKey> exact;  ///< voxels whose distances come from the triangles regardless of thickness
};

/// Measures a surface. Fast where nothing is thin.
/// \param level_set of the surface
/// \param limits voxels
/// \param exact voxels whose cells are smaller for other reasons, ascending
/// \throws Interrupted
LocalThickness measure_local_thickness(const RepairedSurface& surface, const LevelSet& level_set,
                                       const GridFrame& frame, const ThinWalls::Limits& limits,
                                       std::vector<MortonKey> exact, Progress* progress);

/// A region where walls are thickened or omitted, or gaps closed.
struct ChangedWall {
  bool gap = false;
  double thickness = 0;       ///< smallest, voxels
  double min_shown = 0;       ///< thinnest that the cells resolve, voxels
  double area = 0;            ///< of one side, squared voxels
  Vec3 place = Vec3::Zero();  ///< where it is thinnest, voxels
  bool on_purpose = false;    ///< within --min-gap or --min-thickness
  std::vector<Vec3> places;   ///< of a gap: points on its sides, one for each cell, voxels
};

struct ThinWallPlan {
  std::shared_ptr<const ThinWalls> walls;  ///< null if nothing is thin
  RefinementRegions finer;
  std::vector<ChangedWall> changed;
  /// Approximate number of well-shaped tets that fill the walls with parallel sides. Fewer tets would have to
  /// be flat.
  double filling_tets = 0;
  /// As above, for walls that stay thickened.
  double filling_tets_thickened = 0;
};

/// The cells that the chosen depths require, and the corresponding distances.
ThinWallPlan plan_thin_walls(const LocalThickness& measured);

/// The union of both.
RefinementRegions combine(RefinementRegions a, RefinementRegions b);

}  // namespace tetwright

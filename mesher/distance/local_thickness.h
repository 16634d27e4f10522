// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/geometry/morton.h"
#include "common/progress.h"
#include "mesher/distance/level_set.h"
#include "mesher/distance/surface_distance.h"
#include "mesher/distance/thin_walls.h"
#include "mesher/domain/refinement_regions.h"
#include "mesher/input/surface_repair.h"

namespace tetwright {

/// The thin walls and gaps of one surface, measured on its triangles before any cell exists, by connected
/// regions of voxels.
struct LocalThickness {
  struct Region {
    /// Dense tets that it takes if cells are halved so many times where it asks for it, predicted.
    std::array<double, max_wall_refinement + 1> tets{};
    int needed = 0;  ///< halvings that would show all of it
    int asked = 0;   ///< halvings of cells in it for other reasons
    int depth = 0;   ///< halvings that it gets
  };

  std::shared_ptr<const SurfaceDistance> surface;  ///< in voxels; null if nothing is thin
  ThinWalls::Limits limits;
  std::array<int, 3> cells{};         ///< of the frame
  std::vector<MortonKey> voxels;      ///< those with a thin wall or gap, ascending
  std::vector<std::uint32_t> region;  ///< of each of them
  std::vector<Region> regions;
  std::vector<MortonKey> exact;  ///< voxels whose distances come from the triangles, whatever is in them
};

/// Measures a surface: `level_set` is its own, `limits` in voxels, `exact` are voxels whose
/// cells are smaller for other reasons, ascending. Takes little time where nothing is thin. Throws
/// Interrupted.
LocalThickness measure_local_thickness(const RepairedSurface& surface, const LevelSet& level_set,
                                       const GridFrame& frame, const ThinWalls::Limits& limits,
                                       std::vector<MortonKey> exact, Progress* progress);

/// Regions in which cells are split for other reasons are shown by cells as small, crumbs too.
void follow_cells(LocalThickness& measured, const RefinementRegions& finer);

/// What refinement may take.
struct RefinementBudget {
  int max_depth = default_wall_refinement;
  int max_possible = max_wall_refinement;  ///< of the lattice
  /// Deeper than max_depth, up to max_wall_refinement, where it adds fewer tets than `base_tets`.
  bool deeper_where_cheap = true;
  double base_tets = 0;  ///< dense tets without refinement
  double max_tets = 0;   ///< that all regions together may add
};

/// Chooses how deep each region is refined: whole regions, the cheapest first, none beyond the budget.
void choose_depths(const std::vector<LocalThickness*>& all_measured, const RefinementBudget& budget);

/// A region where walls are shown thicker than they are, or gaps are closed.
struct ChangedWall {
  bool gap = false;
  double thickness = 0;       ///< the smallest there is, voxels
  double min_shown = 0;       ///< what the cells show, voxels
  double area = 0;            ///< of one side, squared voxels
  Vec3 place = Vec3::Zero();  ///< where it is thinnest, voxels
  bool on_purpose = false;    ///< within --min-gap or --min-thickness
};

struct ThinWallPlan {
  std::shared_ptr<const ThinWalls> walls;  ///< null if nothing is thin
  RefinementRegions finer;
  std::vector<ChangedWall> changed;
  /// Tets that fill the walls with parallel sides in good shapes, about; fewer would have to be flat.
  double filling_tets = 0;
  /// The same where walls stay as thick as cells show them.
  double filling_tets_thickened = 0;
};

/// The cells that the chosen depths ask for and the distances that go with them.
ThinWallPlan plan_thin_walls(const LocalThickness& measured);

/// Cells of both.
RefinementRegions combine(RefinementRegions a, RefinementRegions b);

}  // namespace tetwright

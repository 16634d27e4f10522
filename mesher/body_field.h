// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "mesher/level_sets/level_set_field.h"
#include "mesher/sizing/narrow_patches.h"
#include "mesher/thin/refinement_depths.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// The field of surfaces on the voxels of a frame: a level set for each body, and one for the inner side of
/// each layer. Later bodies carve earlier ones; layers are cut from the first body by depth.
struct BodyField {
  std::shared_ptr<const LevelSetField> field;
  RefinementRegions finer;  ///< cells to be split for thin walls and gaps of one surface, narrow patches and
                            ///< requested regions
  /// Body and wall, for each wall or gap that stays changed in the mesh.
  std::vector<std::pair<std::size_t, ChangedWall>> changed;
  double filling_tets = 0, filling_tets_thickened = 0;  ///< of all bodies, see ThinWallPlan
  std::vector<TriangleMesh> caps;  ///< of each body's holes, see LevelSet::caps(); input units
};

/// Refinement of one body for reasons other than thin walls.
struct BodyCells {
  NarrowPatches narrow;  ///< ignored for bodies with thin walls, which alone determine their cells
  NarrowPatches asked;   ///< MesherOptions::refinement_regions
};

/// \param limits input units
/// \param cells one for each body, or empty
/// \param progress may be null
/// \throws InputError for a layer thicker than the body
/// \throws Interrupted
BodyField build_field(const MesherInput& input, const GridFrame& voxels, bool keep_outside,
                      const ThinWalls::Limits& limits, const RefinementBudget& budget,
                      std::vector<BodyCells> cells, Progress* progress);

}  // namespace tetwright

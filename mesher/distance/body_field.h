// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/progress.h"
#include "mesher/distance/level_set_field.h"
#include "mesher/distance/local_thickness.h"
#include "mesher/distance/narrow_patches.h"
#include "mesher/input/mesher_input.h"

namespace tetwright {

/// The field of surfaces on the voxels of a frame: a level set for each body and one for the inner side of
/// each layer. Bodies are carved by all later ones; layers are cut from the first body by depth.
struct BodyField {
  std::shared_ptr<const LevelSetField> field;
  RefinementRegions finer;  ///< where walls and gaps of one surface are thin, or patches narrow
  /// Of each body, those that are still shown otherwise than they are.
  std::vector<std::pair<std::size_t, ChangedWall>> changed;
  double filling_tets = 0, filling_tets_thickened = 0;  ///< of all bodies, see ThinWallPlan
};

/// What one body asks for besides its thin walls.
struct BodyCells {
  NarrowPatches narrow;  ///< dropped where the body has thin walls, which alone choose cells then
  NarrowPatches asked;   ///< MesherOptions::refinement_regions
};

/// `limits` in input units; `cells` of each body, or empty. Throws InputError for layers thicker than the
/// body, Interrupted.
BodyField build_field(const MesherInput& input, const GridFrame& voxels, bool keep_outside,
                      const ThinWalls::Limits& limits, const RefinementBudget& budget,
                      std::vector<BodyCells> cells, Progress* progress);

}  // namespace tetwright

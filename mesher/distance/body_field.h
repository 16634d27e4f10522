#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/progress.h"
#include "mesher/distance/level_set_field.h"
#include "mesher/distance/narrow_patches.h"
#include "mesher/distance/thin_survey.h"
#include "mesher/input/mesher_input.h"

namespace tetwright {

/// The field of surfaces on the voxels of a frame: a level set for each body and one for the inner side of
/// each layer. Bodies are carved by all later ones; layers are cut from the first body by depth.
struct BodyField {
  std::shared_ptr<const LevelSetField> field;
  FinerCells finer;  ///< where walls and gaps of one surface are thin, or patches narrow
  /// Of each body, those that are still shown otherwise than they are.
  std::vector<std::pair<std::size_t, ChangedWall>> changed;
  double filling_tets = 0, filling_tets_thickened = 0;  ///< of all bodies, see ThinWallPlan
};

/// `limits` in input units; `narrow` of each body, or empty. Throws InputError for layers thicker than the
/// body, Interrupted.
BodyField build_field(const MesherInput& input, const GridFrame& voxels, bool keep_outside,
                      const ThinWalls::Limits& limits, const RefinementBudget& budget,
                      std::vector<NarrowPatches> narrow, Progress* progress);

}  // namespace tetwright

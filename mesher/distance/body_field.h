#pragma once

#include <memory>

#include "common/progress.h"
#include "mesher/distance/material_field.h"
#include "mesher/input/mesher_input.h"

namespace tetwright {

/// The field of surfaces on the voxels of a frame: a level set for each body and one for the inner side of
/// each layer. Bodies are carved by all later ones; layers are cut from the first body by depth.
///
/// Throws InputError for layers thicker than the body, Interrupted.
std::shared_ptr<const MaterialField> build_field(const MesherInput& input, const GridFrame& voxels,
                                                 bool keep_outside, Progress* progress);

}  // namespace tetwright

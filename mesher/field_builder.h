#pragma once

#include <memory>

#include "common/progress.h"
#include "mesher/material_field.h"
#include "mesher/mesher.h"

namespace tetwright {

/// What the outside is called where it is meshed.
inline constexpr MaterialTag outside_tag = 0;
inline constexpr const char* outside_name = "outside";

/// The regions of an input on the voxels of a frame: a level set for each body and one for each layer's inner
/// side. A body is carved by all later ones; layers are cut from the first body by depth.
///
/// Throws InputError for a layer that is thicker than the body, Interrupted.
std::shared_ptr<const MaterialField> build_field(const PreparedInput& input, const GridFrame& voxels,
                                                 bool keep_outside, Progress* progress);

}  // namespace tetwright

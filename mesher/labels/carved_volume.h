// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/domain/material_field.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// A flag for each region of a volume: bodies do not carve it.
std::vector<std::uint8_t> protected_regions(const ImplantedVolume& volume);

/// Measures what bodies take of the labels. Voxels that a surface passes are sampled at 4^3 points. Parallel
/// over slices of the bodies' box.
/// \param bodies their field, unrefined
/// \throws Interrupted
CarvedLabels measure_carving(const ImplantedVolume& volume, const MaterialField& bodies,
                             const Progress* progress);

}  // namespace tetwright

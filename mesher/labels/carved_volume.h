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

/// The parts of a body in the voxels of a volume, in voxels.
struct BodyInLabels {
  double in_volume = 0;
  double in_labels = 0;         ///< without the outside
  double in_protected = 0;      ///< of protected labels
  double beside_protected = 0;  ///< in voxels that touch one of these, at least in a corner
};

struct Carving {
  CarvedLabels labels;
  std::vector<BodyInLabels> bodies;
};

/// Measures what bodies take of the labels. Voxels that a surface passes are sampled at 4^3 points, or more
/// where they are long. Parallel over slices of the bodies' box.
/// \param bodies their field, unrefined
/// \throws Interrupted
Carving measure_carving(const ImplantedVolume& volume, const MaterialField& bodies, const Progress* progress);

}  // namespace tetwright

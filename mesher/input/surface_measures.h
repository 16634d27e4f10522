// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/mesher_input.h"

namespace tetwright {

/// Sets the bounding box, area and volume of a surface from its points and triangles. Sums are added up in
/// the same order for any number of threads.
void measure_surface(RepairedSurface& surface);

}  // namespace tetwright

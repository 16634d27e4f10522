// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "mesher/input/open_surfaces.h"

namespace tetwright {

/// Makes open components that are height fields over the plane z = 0 the tops of blocks: adds vertical walls
/// below their outer rims and flat faces at the height of the base. Rims of holes within them stay open. The
/// groups are called "top" (triangles without a group), "side" and "base".
/// \return what was done
/// \throws InputError for components that overhang, and walls that cross each other, with the position
/// \throws UsageError for a base that is not below the surface
Diagnostic add_base(OrientedSurface& surface, const std::string& file, const BaseHeight& base);

}  // namespace tetwright

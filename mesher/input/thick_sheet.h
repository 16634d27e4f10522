// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "mesher/input/open_surfaces.h"

namespace tetwright {

/// Makes open components the front of shells of constant thickness, which lie behind them: adds the surface
/// at that distance, with edges as sharp as those of the front, and faces between both rims, square to the
/// front. The groups are called "front" (triangles without a group), "back" and "rim".
///
/// The back's points have the distance from the planes of all triangles around them where these have up to
/// three directions. Where the back would turn over, as within curves and noise that are narrower than it is
/// far away, its points follow those around them.
/// \param thickness above 0, input units
/// \return what was done
/// \throws InputError for edges of three or more triangles, and for a shell that crosses itself, with the
///   position
Diagnostic thicken(OrientedSurface& surface, const std::string& file, double thickness);

}  // namespace tetwright

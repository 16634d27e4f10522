// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// Replaces the surface of a body that crosses itself by the boundary of all that it encloses (positive
/// winding number), if it is closed, and a part by its sharp edges: the curves in which its smooth patches
/// cross become edges, and what lies inside goes. All other surfaces stay as they are: scans, and surfaces
/// that cross themselves within a patch.
/// \param tolerance as for imprint_surfaces(), input units
/// \param progress may be null
/// \return whether the surface was replaced
/// \throws Interrupted
bool resolve_self_crossings(MesherInput::Body& body, double tolerance, Progress* progress);

}  // namespace tetwright

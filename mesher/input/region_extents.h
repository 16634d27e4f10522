// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tetwright/mesher_input.h"

namespace tetwright {

/// Size of a region of space.
struct RegionExtent {
  double volume = 0;  ///< input units cubed
  double area = 0;    ///< of its whole boundary, cavities included; input units squared
  /// Numbers of connected parts of its boundary that are closed, such as balls, and of regions on the other
  /// side of its other parts: not more than there are.
  std::size_t closed_parts = 0, open_parts = 0;
  /// Factor on the tets that fill it: of labels, since oblique sheets of about one voxel vary in thickness;
  /// otherwise 1.
  double unevenness = 1;
};

/// The extent of each body's material: the body without what later ones take from it, and before layers are
/// cut from it. Nothing for a body that is hidden, or part of whose surface is inside another body without
/// being joined to it.
///
/// Holes of open surfaces add nothing to the area; the volume is then that of cones from the centre of the
/// body's box. O(n) and a few winding numbers for each component.
std::vector<std::optional<RegionExtent>> region_extents(const MesherInput& input);

/// The extent of all that is within a body's own surface.
RegionExtent extent_within(const RepairedSurface& surface);

}  // namespace tetwright

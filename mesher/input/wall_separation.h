// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesher/input/connected_patches.h"
#include "mesher/input/divided_surface.h"
#include "mesher/input/inner_walls.h"
#include "mesher/input/surface_cleaning.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"

namespace tetwright {

/// A surface that consists of the boundaries of cells and of walls inside these.
struct WalledSurface {
  ConnectedPatches patches;
  DividedSurface divided;
  /// The walls, if they were taken out of the surface. Otherwise walls divide it into several cells.
  std::optional<InnerWalls> walls;
  /// As it was given, if the walls were taken out.
  std::optional<CleanedSurface> given;
};

/// Decides whether open pieces of a surface are walls inside the solid that its closed pieces enclose. If so,
/// takes the walls out, unless others divide the solid into cells. A surface with holes, loose pieces outside
/// or without a closed part is left as it is, and so are closed shells that touch, cross or contain each
/// other.
///
/// Cost: for surfaces that have free edges or odd junctions about that of their repair, see repair_surface();
/// for others O(n log n).
/// \param surface loses its walls
/// \throws UsageError for a contact tolerance that is not above 0
/// \param progress may be null
/// \return nothing if the surface is left as it is, and no cells are known
/// \throws InputError as repair_surface() does
/// \throws Interrupted
std::optional<WalledSurface> separate_walls(CleanedSurface& surface, const std::string& file,
                                            NestedRule nested, RegionRule rule, const ContactOptions& contact,
                                            Progress* progress);

/// Finds the walls inside solids, see find_inner_walls().
/// \param solids closed and oriented outwards
InnerWalls walls_inside(const std::vector<const RepairedSurface*>& solids, const CleanedSurface& surface,
                        const ConnectedPatches& patches, const DividedSurface& divided);

}  // namespace tetwright

#pragma once

#include <optional>
#include <vector>

#include "mesher/material_field.h"

namespace tetwright {

/// Cells smaller than a voxel have at most this many levels below it.
inline constexpr int most_refinement = 3;

/// A region that is too thin for its cells somewhere.
struct ThinPart {
  RegionIndex region;
  std::size_t places;  ///< voxels (or, for a sheet, finest cells) where it is
  Vec3 first;          ///< one of them, in voxels
};

/// Sheets between two level sets (layers, what is left between nested surfaces) that are thinner than one and
/// a half cells tear in a lattice of voxels, though the level sets know them exactly.
struct ThinSheets {
  int refinement = 0;                         ///< levels below a voxel that they need
  std::vector<std::vector<MortonKey>> cells;  ///< to be split, by level of a lattice refined so; ascending
  std::vector<ThinPart> too_thin;             ///< still thinner than one and a half of the smallest cells
};

/// Looks at the voxels that hold an interface. `field` is not refined. Costs nothing for a single level set.
ThinSheets find_thin_sheets(const MaterialField& field, const std::vector<MortonKey>& interface_voxels);

/// Regions, outside among them, that are thinner than two voxels somewhere and no such sheets, in the order
/// of their numbers: their topology may differ from the input's there. `field` is not refined.
std::vector<ThinPart> find_thin_parts(const MaterialField& field,
                                      const std::vector<MortonKey>& interface_voxels);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/label_volume.h"
#include "common/triangle_mesh.h"

namespace tetwright {

// Files of OpenVDB (.vdb), the exchange format of level sets; they may also hold segmented volumes.

/// Reads the level sets of a file as surfaces: their zero levels in the file's world coordinates, oriented
/// with the negative side inside, and closed unless the level set itself ends. In the file's order.
///
/// A level set is a grid of floats of the class "level set", or without a class but with a positive
/// background and values of both signs. Other grids are ignored.
///
/// Throws InputError that begins with `file`: not a .vdb file, damaged or cut short, no level set in it (with
/// what there is), two of one name, one without a surface. Memory grows with the file.
std::vector<NamedSurface> read_level_sets(const std::string& file);

/// Reads the labels of a file that has no level set but one grid of int32 or int64; returns nothing for a
/// file with a level set or without such a grid. The volume is the bounding box of the active voxels;
/// inactive voxels in it have the values that OpenVDB gives them, usually the background. Indices are at the
/// centres of voxels.
///
/// Throws InputError that begins with `file`: not a .vdb file, damaged or cut short, several such grids (with
/// their names), no active voxel, more than `max_voxels` voxels (2^31 or fewer), values beyond 32 bits, a
/// transform that isn't linear or can't be inverted. Memory grows with the file and 4 bytes for each voxel.
std::optional<LabelVolume> read_label_grid(const std::string& file,
                                           std::size_t max_voxels = std::size_t{1} << 31);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/label_volume.h"
#include "common/triangle_mesh.h"

namespace tetwright {

// OpenVDB files (.vdb), the exchange format of level sets; they may also hold segmented volumes.

/// Reads the level sets of a file as surfaces, in the file's order: their zero levels in the file's world
/// coordinates, oriented with the negative side inside, and closed unless the level set itself ends. Memory
/// grows with the file.
///
/// A level set is a grid of floats of the class "level set", or without a class but with a positive
/// background and values of both signs. Other grids are ignored.
///
/// \throws InputError beginning with `file`: not a .vdb file, damaged or cut short, no level set in it (with
///   a list of the grids), two of one name, one without a surface
std::vector<NamedSurface> read_level_sets(const std::string& file);

/// Reads the labels of a file that has no level set but one grid of int32 or int64. The volume is the
/// bounding box of the active voxels; inactive voxels in it have the values that OpenVDB gives them, usually
/// the background. Index coordinates are those of voxel centres. Memory grows with the file and by 4 bytes
/// per voxel.
///
/// \param max_voxels 2^31 or fewer
/// \return nothing for a file with a level set or without such a grid
/// \throws InputError beginning with `file`: not a .vdb file, damaged or cut short, several such grids (with
///   their names), no active voxel, more than `max_voxels` voxels, values beyond 32 bits, a transform that is
///   not linear or not invertible
std::optional<LabelVolume> read_label_grid(const std::string& file,
                                           std::size_t max_voxels = std::size_t{1} << 31);

}  // namespace tetwright

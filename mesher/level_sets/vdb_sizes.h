// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "tetwright/sizes.h"

namespace tetwright {

/// Reads edge lengths from a grid of floats or doubles in a .vdb file: the grid with the first possible name
/// in size_names (tetwright/sizes.h), else the only such grid not of the class "level set". Memory
/// grows with the file.
///
/// Lengths are given at the centres of active voxels, positioned by the grid's transform, and interpolated
/// trilinearly. at() returns std::nullopt if a voxel that it needs is inactive, as beyond the outermost
/// centres. A point within tolerance::coinciding_cells of a plane of centres needs only the voxels on that
/// plane. An active tile counts as its voxels. for_each_value() visits each active voxel outside tiles, and
/// the eight corner voxels of each active tile.
///
/// \throws InputError beginning with `file`: not a .vdb file, damaged or truncated, no such grid or several
///   (with a list), no active voxel, an active value that is not finite or not above 0 (with its position), a
///   transform that is not linear or not invertible
std::unique_ptr<const SizeSource> read_vdb_sizes(const std::string& file);

}  // namespace tetwright

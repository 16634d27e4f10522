// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "common/sizes/size_source.h"

namespace tetwright {

/// Reads edge lengths from a grid of floats or doubles in a .vdb file: the first of the names size_names
/// (common/sizes/size_source.h) that a grid has, else the only such grid that is not of the class "level
/// set".
///
/// Lengths are at active voxels' centres, where the grid's transform puts them, and trilinear between. at()
/// gives nothing where one of the voxels that it would need is inactive, also beyond the outermost centres;
/// places within tolerance::coinciding_cells of a centre's plane need the voxels on it alone. Active tiles
/// count as their voxels. for_each_value() gives each active voxel, and of an active tile the first and last
/// voxels along each axis, its corners.
///
/// Throws InputError that begins with `file`: not a .vdb file, damaged or cut short, no such grid or several
/// (with what there is), no active voxel, a value of an active voxel that is not finite or not above 0 (with
/// its place), a transform that isn't linear or can't be inverted. Memory grows with the file.
std::unique_ptr<const SizeSource> read_vdb_sizes(const std::string& file);

}  // namespace tetwright

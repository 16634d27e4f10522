// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The grid of a segmented volume, with what its file says of the labels. The grid's axes need be neither
/// perpendicular nor right-handed.
///
/// Voxels are cell-centred: index (i, j, k) is the centre of a voxel, which extends half a step to each side.
struct LabelGrid {
  std::array<int, 3> size{};   ///< voxels along each axis, 1 or more
  Vec3 origin = Vec3::Zero();  ///< centre of voxel (0, 0, 0), input units
  /// Column a is the step from one voxel to the next along axis a, input units. The matrix has rank 3.
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
  /// True if the file gives no spacing although its format could, so that 1 is a guess.
  bool spacing_assumed = false;
  /// Coordinate system that the file names: "left-posterior-superior", "right-anterior-superior" and so on,
  /// or empty. Readers do not convert between them.
  std::string space;
  /// Names of labels in the file, including labels that no voxel has; names may repeat.
  std::map<MaterialTag, std::string> names = {};
  /// Colours of labels in the file: red, green, blue, each 0 to 1.
  std::map<MaterialTag, std::array<double, 3>> colours = {};
  /// True if the file gives another spacing than set_spacing() did.
  bool spacing_replaced = false;
  /// Files in the folder of the slices that are no slices, without the folder.
  std::vector<std::string> ignored_files = {};

  /// Position of a voxel index, input units. `index` may be fractional.
  Vec3 to_input(const Vec3& index) const;
  /// Number of voxels of the whole grid.
  std::uint64_t voxels() const;
};

/// Converts a grid to another coordinate system, if both are such as "left-posterior-superior": coordinates
/// along the axes that point the other way change their signs.
/// \param space see LabelGrid::space
/// \return false if nothing changed: the systems are equal, or one of them is unknown
bool change_space(LabelGrid& grid, const std::string& space);

/// Sets the distance between voxels along each axis, and keeps the axes and the origin.
/// \param spacing input units, above 0
void set_spacing(LabelGrid& grid, const Vec3& spacing);

/// A segmented volume in memory: a label for each voxel.
struct LabelVolume : LabelGrid {
  std::vector<MaterialTag> labels;  ///< the first axis fastest
};

/// Checks a grid.
/// \param file file name for messages
/// \throws InputError unless origin and directions are finite and the directions are invertible
void check_geometry(const LabelGrid& grid, const std::string& file);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tetwright/mesher_input.h"

namespace tetwright {

/// The depth of each voxel's centre in its label (or in the outside): the length of the shortest path to
/// another label in steps between voxels, index space.
struct DistanceTransform {
  static constexpr int steps_per_voxel = 3;
  std::array<int, 3> size{};
  std::vector<std::uint8_t> steps;  ///< first axis fastest

  /// Interpolates trilinearly between voxel centres; result and gradient in voxels.
  /// \param index index space, clamped to the volume
  double at(const Vec3& index, Vec3& gradient) const;
};

/// Chamfer distances (Borgefors 1986: weights 3, 4, 5 for neighbours across faces, edges, corners; within 8 %
/// of the Euclidean ones) minus half a voxel, at most 85 voxels. Regions continue beyond the volume. Needed
/// for coarse cells, for which distances clamped to two voxels do not locate the interface.
DistanceTransform distance_transform(const LabelInput& labels);

}  // namespace tetwright

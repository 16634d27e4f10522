#pragma once

#include <cstdint>
#include <vector>

#include "mesher/label_input.h"

namespace tetwright {

/// How deep in its label each voxel's centre is, and the same for outside: the way to the nearest other
/// label, by steps between voxels, index space.
struct LabelDepths {
  static constexpr int steps_per_voxel = 3;
  std::array<int, 3> size{};
  std::vector<std::uint8_t> steps;  ///< first axis fastest

  /// Trilinear between voxels' centres, voxels; `index` in index space, beyond the volume as at its border.
  double at(const Vec3& index, Vec3& gradient) const;
};

/// Chamfer distances (Borgefors 1986: 3, 4, 5 for neighbours by faces, edges, corners; within 8 % of the true
/// ones) less half a voxel, at most 85 voxels. For cells so coarse that what is cut off two voxels from an
/// interface does not tell where it is. Beyond the volume is outside.
LabelDepths label_depths(const PreparedLabels& labels);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "common/surface_region.h"
#include "common/tet_mesh.h"
#include "mesher/input/mesher_input.h"

namespace tetwright {

/// A patch that the user named or numbered, in the input and in the result.
struct PatchComparison {
  SurfaceRegion group;
  double input_area = 0, area = 0;  ///< input units squared
  std::size_t triangles = 0;        ///< of the result
  Vec3 place = Vec3::Zero();        ///< on it in the input, input units

  bool lost() const { return triangles == 0; }
};

/// The patches of an input, by their numbers and names.
std::vector<PatchComparison> patches_of_input(const MesherInput& input);
std::vector<PatchComparison> patches_of_input(const TetMesh& mesh);

/// Fills in what the result has of them.
void compare_patches(const TetMesh& result, std::vector<PatchComparison>& patches);

}  // namespace tetwright

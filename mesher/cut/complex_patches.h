// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "mesher/complex/labelled_complex.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// The patches of a complex: the faces of one pair of regions that belong to the same patch of each of the
/// bodies whose surface they are.
struct ComplexPatches {
  /// The faces of the complex; towards the outside if that is on one side.
  std::vector<Triangle> triangles;
  std::vector<std::uint16_t> patches;  ///< of each triangle
  /// A *sheet* is the faces of one pair of regions, ascending.
  std::map<std::pair<RegionIndex, RegionIndex>, std::size_t> sheets;
  std::vector<std::size_t> sheet_of_patch;
  /// Surface region of the input that each patch belongs to, or none. Where two bodies have one, that of the
  /// later body.
  std::vector<SurfaceRegion> groups;
};

/// \pre input.complex
/// \param patches of each body's surface
/// \throws InputError for more than 65,534 patches
ComplexPatches complex_patches(const MesherInput& input, const std::vector<SurfacePatches>& patches);

}  // namespace tetwright

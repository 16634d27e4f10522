// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// A face of a tet mesh and the tets it is part of.
struct MeshFace {
  Triangle ids;         ///< ascending
  Index first;          ///< the tet of the smallest number
  Index second;         ///< the next one, or no_index on the boundary
  std::uint32_t count;  ///< how many there are; more than two only in a broken mesh
};

/// All faces in lexicographic order of their ids. `points` is the number of points; ids must be below it.
/// With `candidates`, a flag for each point, only the faces of three flagged points. Memory: at the peak
/// about 100 bytes for each tet; with candidates 50 for each face found and 8 for each point. Parallel; the
/// result does not depend on the threads.
std::vector<MeshFace> mesh_faces(std::span<const Tet> tets, std::size_t points,
                                 const std::vector<std::uint8_t>* candidates = nullptr);

}  // namespace tetwright

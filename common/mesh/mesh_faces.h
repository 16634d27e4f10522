// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// A face of a tet mesh and its tets.
struct MeshFace {
  Triangle ids;         ///< ascending
  Index first;          ///< its tet with the smallest index
  Index second;         ///< the next one, or no_index on the boundary
  std::uint32_t count;  ///< number of its tets; more than two only in a broken mesh
};

/// All faces in lexicographic order of their ids. Parallel; the result does not depend on the number of
/// threads. Peak memory about 100 bytes for each tet; with candidates 50 for each face found and 8 for each
/// point.
/// \param points number of points; ids are below it
/// \param candidates a flag for each point: only faces of three flagged points are listed; null: all
std::vector<MeshFace> mesh_faces(std::span<const Tet> tets, std::size_t points,
                                 const std::vector<std::uint8_t>* candidates = nullptr);

}  // namespace tetwright

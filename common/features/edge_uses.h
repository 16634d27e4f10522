// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Use of an edge by a triangle.
struct EdgeUse {
  std::uint64_t key;  ///< both endpoints, the smaller one in the upper 32 bits
  std::uint32_t group;
  Index triangle;
  bool ascending;  ///< true if the triangle traverses the edge from the smaller endpoint to the larger

  bool same_edge(const EdgeUse& o) const { return key == o.key && group == o.group; }
};

/// Lists the edge uses of all triangles, sorted by edge, then group, then triangle.
/// \param groups empty, or one for each triangle
std::vector<EdgeUse> edge_uses(std::span<const Triangle> triangles, std::span<const std::uint32_t> groups);

/// Endpoints of an edge, the smaller one first.
inline std::array<Index, 2> ends_of(std::uint64_t key) {
  return {static_cast<Index>(key >> 32), static_cast<Index>(key)};
}

}  // namespace tetwright

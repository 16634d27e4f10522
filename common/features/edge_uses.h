// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/types.h"

namespace tetwright {

/// A triangle's use of an edge.
struct EdgeUse {
  std::uint64_t key;  ///< both endpoints, the smaller one in the upper 32 bits
  std::uint32_t group;
  Index triangle;
  bool ascending;  ///< whether the triangle runs from the smaller end to the larger one

  bool same_edge(const EdgeUse& o) const { return key == o.key && group == o.group; }
};

/// Lists the uses of all edges, sorted by edge, then group, then triangle.
/// \param groups empty, or one for each triangle
std::vector<EdgeUse> edge_uses(std::span<const Triangle> triangles, std::span<const std::uint32_t> groups);

/// Endpoints of an edge, the smaller one first.
inline std::array<Index, 2> ends_of(std::uint64_t key) {
  return {static_cast<Index>(key >> 32), static_cast<Index>(key)};
}

}  // namespace tetwright

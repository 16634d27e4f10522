// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "simplify/mesh/star.h"

namespace tetwright {

/// Kinds of vertices, for collapses (README.md, Topology).
enum class VertexKind : std::uint8_t {
  interior,        ///< dimension 3: within one material
  interface,       ///< dimension 2: on the boundary, an interface or a patch
  junction_curve,  ///< dimension 1: on a curve where interfaces meet, or on a feature edge between patches
  corner,          ///< dimension 0
  frozen           ///< of any dimension
};
inline constexpr std::size_t vertex_kind_count = 5;

/// Table entry for a collapse that is refused along any edge.
inline constexpr std::uint8_t never = 0;

/// Dimension of the edge along which a vertex (row) may be collapsed onto another one (column), or `never`:
/// the removed vertex's own dimension, which keeps it within its material, interface or curve. No end of an
/// edge has a larger dimension than the edge. Frozen vertices are never removed, but others may collapse onto
/// them. Among labels of a volume, two more are possible (Workspace::is_crossing(), may_merge_with()).
inline constexpr std::array<std::array<std::uint8_t, vertex_kind_count>, vertex_kind_count> collapse_table{{
    // onto interior, interface, junction_curve, corner, frozen
    {3, 3, 3, 3, 3},                      // interior
    {never, 2, 2, 2, 2},                  // interface
    {never, never, 1, 1, 1},              // junction_curve
    {never, never, never, never, never},  // corner
    {never, never, never, never, never},  // frozen
}};

/// Dimension of all edges along which a vertex of this kind may be collapsed; `never` if there are none. This
/// test suffices: no edge of this dimension leads to a target that the vertex's row refuses.
constexpr int collapsible_edge(VertexKind kind) {
  for (const std::uint8_t dimension : collapse_table[static_cast<std::size_t>(kind)])
    if (dimension != never) return dimension;
  return never;
}

/// Kind of the star's centre.
inline VertexKind vertex_kind(const Star& star) {
  return star.frozen ? VertexKind::frozen : static_cast<VertexKind>(3 - star.dimension());
}

}  // namespace tetwright

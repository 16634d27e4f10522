// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "common/tet_mesh.h"

namespace tetwright {

/// The edges of a tet in the order in which its midside nodes are listed: that of VTK, Abaqus, Nastran and
/// FEBio. Gmsh swaps the last two.
inline constexpr std::array<std::array<std::size_t, 2>, 6> tet_midside_edges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// The ends of an edge, the smaller first.
inline std::array<Index, 2> ascending_edge(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// The nodes in the middle of edges that make second-order elements of the tets of a mesh.
struct MidsideNodes {
  std::vector<std::array<Index, 2>> edges;     ///< ascending, each listed from its smaller point on
  std::vector<Vec3> points;                    ///< one for each edge, input units
  std::vector<std::array<Index, 6>> of_tets;   ///< indices into `points`, in the order of tet_midside_edges
  std::vector<std::array<Index, 3>> of_faces;  ///< those of the interfaces' edges 01, 12 and 20
};

/// Adds to fields of the points their values in the midside nodes, after those of the points: the means of
/// both ends, rounded in fields of whole numbers.
std::vector<MeshField> fields_of_nodes(std::vector<MeshField> point_fields, const MidsideNodes& nodes);

/// Nodes halfway between the ends of each edge: straight elements. O(n log n).
MidsideNodes straight_midside_nodes(const TetMesh& mesh);

}  // namespace tetwright

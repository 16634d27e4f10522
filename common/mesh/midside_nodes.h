// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "common/tet_mesh.h"

namespace tetwright {

/// Edges of a tet in the order of its midside nodes in VTK, Abaqus, Nastran and FEBio. Gmsh swaps the last
/// two.
inline constexpr std::array<std::array<std::size_t, 2>, 6> tet_midside_edges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// Endpoints of an edge, the smaller one first.
inline std::array<Index, 2> ascending_edge(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// Midside nodes that turn the tets of a mesh into second-order elements.
struct MidsideNodes {
  std::vector<std::array<Index, 2>> edges;     ///< ascending, each listed from its smaller point on
  std::vector<Vec3> points;                    ///< one for each edge, input units
  std::vector<std::array<Index, 6>> of_tets;   ///< indices into `points`, in the order of tet_midside_edges
  std::vector<std::array<Index, 3>> of_faces;  ///< likewise, for the interfaces' edges 01, 12, 20
};

/// Extends fields of points to the midside nodes, which follow the points: means of both endpoints, rounded
/// in integer fields.
std::vector<MeshField> fields_of_nodes(std::vector<MeshField> point_fields, const MidsideNodes& nodes);

/// Places nodes halfway between the endpoints of each edge: straight elements. O(n log n).
MidsideNodes straight_midside_nodes(const TetMesh& mesh);

}  // namespace tetwright

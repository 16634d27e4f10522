// SPDX-License-Identifier: Apache-2.0
#include "tetwright/tet_mesh.h"

#include <algorithm>
#include <cmath>

namespace tetwright {

std::vector<MeshField> fields_of_nodes(std::vector<MeshField> point_fields, const MidsideNodes& nodes) {
  for (MeshField& field : point_fields) {
    const auto components = static_cast<std::size_t>(field.components);
    field.values.reserve(field.values.size() + components * nodes.edges.size());
    for (const auto& [a, b] : nodes.edges)
      for (std::size_t k = 0; k < components; ++k) {
        const double mean = 0.5 * field.values[a * components + k] + 0.5 * field.values[b * components + k];
        field.values.push_back(field.integer ? std::round(mean) : mean);
      }
  }
  return point_fields;
}

MidsideNodes straight_midside_nodes(const TetMesh& mesh) {
  MidsideNodes nodes;
  nodes.edges.reserve(6 * mesh.tets.size());
  for (const Tet& tet : mesh.tets)
    for (const auto& [a, b] : tet_midside_edges) nodes.edges.push_back(ascending_edge(tet[a], tet[b]));
  std::sort(nodes.edges.begin(), nodes.edges.end());
  nodes.edges.erase(std::unique(nodes.edges.begin(), nodes.edges.end()), nodes.edges.end());
  nodes.edges.shrink_to_fit();
  // First edge of each smaller endpoint.
  std::vector<Index> starts(mesh.points.size() + 1, 0);
  for (const auto& edge : nodes.edges) ++starts[edge[0] + std::size_t{1}];
  for (std::size_t p = 0; p < mesh.points.size(); ++p) starts[p + 1] += starts[p];
  const auto find = [&](Index a, Index b) {
    const std::array<Index, 2> edge = ascending_edge(a, b);
    const auto begin = nodes.edges.begin() + starts[edge[0]];
    const auto end = nodes.edges.begin() + starts[edge[0] + std::size_t{1}];
    return static_cast<Index>(std::lower_bound(begin, end, edge) - nodes.edges.begin());
  };
  for (const auto& [a, b] : nodes.edges) nodes.points.push_back(0.5 * mesh.points[a] + 0.5 * mesh.points[b]);
  nodes.of_tets.reserve(mesh.tets.size());
  for (const Tet& tet : mesh.tets) {
    std::array<Index, 6>& of_tet = nodes.of_tets.emplace_back();
    for (std::size_t e = 0; e < 6; ++e)
      of_tet[e] = find(tet[tet_midside_edges[e][0]], tet[tet_midside_edges[e][1]]);
  }
  for (const InterfaceTriangle& t : mesh.interfaces)
    nodes.of_faces.push_back({find(t.ids[0], t.ids[1]), find(t.ids[1], t.ids[2]), find(t.ids[2], t.ids[0])});
  return nodes;
}

}  // namespace tetwright

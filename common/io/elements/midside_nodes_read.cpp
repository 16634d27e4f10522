// SPDX-License-Identifier: Apache-2.0
#include "common/io/elements/midside_nodes_read.h"

#include <algorithm>
#include <cstdint>

namespace tetwright {

void MidsideNodesRead::remove_from(ReadTetMesh& read, std::vector<Triangle>& triangles) const {
  if (tets_ == 0 && nodes_.empty()) return;
  TetMesh& mesh = read.mesh;
  const std::size_t before = mesh.points.size();
  std::vector<std::uint8_t> removed(before, 0);
  for (const Index node : nodes_)
    if (node != no_index) removed[node] = 1;
  const auto keep = [&](const auto& corners) {
    for (const Index v : corners)
      if (v != no_index) removed[v] = 0;
  };
  for (const Tet& tet : mesh.tets) keep(tet);
  for (const Triangle& t : triangles) keep(t);
  for (const Wedge& wedge : mesh.wedges) keep(wedge);

  std::vector<Index> new_index(before, no_index);
  Index next = 0;
  for (std::size_t p = 0; p < before; ++p) {
    if (removed[p]) continue;
    mesh.points[next] = mesh.points[p];
    for (MeshField& field : mesh.point_fields) {
      const auto n = static_cast<std::size_t>(field.components);
      std::copy_n(field.values.begin() + static_cast<std::ptrdiff_t>(p * n), n,
                  field.values.begin() + static_cast<std::ptrdiff_t>(next * n));
    }
    new_index[p] = next++;
  }
  mesh.points.resize(next);
  for (MeshField& field : mesh.point_fields)
    field.values.resize(next * static_cast<std::size_t>(field.components));
  const auto renumber = [&](auto& corners) {
    for (Index& v : corners)
      if (v != no_index) v = new_index[v];
  };
  for (Tet& tet : mesh.tets) renumber(tet);
  for (Triangle& t : triangles) renumber(t);
  for (Wedge& wedge : mesh.wedges) renumber(wedge);
  if (before > next)
    read.dropped.push_back({"midside nodes; tets of ten nodes are reduced to their corners", before - next});
}

}  // namespace tetwright

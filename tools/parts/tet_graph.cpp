// SPDX-License-Identifier: Apache-2.0
#include "tools/parts/tet_graph.h"

#include <algorithm>
#include <utility>

#include "common/geometry/morton.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

TetNeighbours tet_neighbours(const TetMesh& mesh) {
  TetNeighbours neighbours(mesh.tets.size(), {no_index, no_index, no_index, no_index});
  const auto add = [&](Index tet, Index other) {
    for (Index& slot : neighbours[tet])
      if (slot == no_index) {
        slot = other;
        return;
      }
  };
  for (const MeshFace& face : mesh_faces(mesh.tets, mesh.points.size())) {
    if (face.second == no_index) continue;
    add(face.first, face.second);
    add(face.second, face.first);
  }
  return neighbours;
}

WeightedGraph subgraph(const WeightedGraph& graph, const std::vector<std::int32_t>& vertices) {
  WeightedGraph part;
  part.starts.push_back(0);
  for (const std::int32_t vertex : vertices) {
    const auto v = static_cast<std::size_t>(vertex);
    for (auto e = static_cast<std::size_t>(graph.starts[v]);
         e < static_cast<std::size_t>(graph.starts[v + 1]); ++e) {
      const auto other = std::lower_bound(vertices.begin(), vertices.end(), graph.neighbours[e]);
      if (other == vertices.end() || *other != graph.neighbours[e]) continue;
      part.neighbours.push_back(static_cast<std::int32_t>(other - vertices.begin()));
      if (!graph.edge_weights.empty()) part.edge_weights.push_back(graph.edge_weights[e]);
    }
    part.starts.push_back(static_cast<std::int32_t>(part.neighbours.size()));
    if (!graph.vertex_weights.empty()) part.vertex_weights.push_back(graph.vertex_weights[v]);
  }
  return part;
}

WeightedGraph graph_of(const TetNeighbours& neighbours) {
  WeightedGraph graph;
  graph.starts.push_back(0);
  for (const std::array<Index, 4>& of_tet : neighbours) {
    for (const Index other : of_tet)
      if (other != no_index) graph.neighbours.push_back(static_cast<std::int32_t>(other));
    graph.starts.push_back(static_cast<std::int32_t>(graph.neighbours.size()));
  }
  return graph;
}

TetClusters cluster_tets(const TetMesh& mesh, const TetNeighbours& neighbours, std::size_t size) {
  TetClusters clusters;
  clusters.of_tet.assign(mesh.tets.size(), no_index);
  if (mesh.tets.empty()) return clusters;
  Vec3 low = mesh.points[mesh.tets[0][0]], high = low;
  for (const Vec3& p : mesh.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const MortonGrid grid(low, high);
  std::vector<std::pair<MortonKey, Index>> order;
  order.reserve(mesh.tets.size());
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    Vec3 centre = Vec3::Zero();
    for (const Index p : mesh.tets[t]) centre += 0.25 * mesh.points[p];
    order.emplace_back(grid.key(centre), t);
  }
  std::sort(order.begin(), order.end());
  std::vector<Index> grown;
  for (const auto& [key, first] : order) {
    if (clusters.of_tet[first] != no_index) continue;
    const auto cluster = static_cast<Index>(clusters.count++);
    grown.assign(1, first);
    clusters.of_tet[first] = cluster;
    for (std::size_t i = 0; i < grown.size(); ++i)
      for (const Index other : neighbours[grown[i]]) {
        if (grown.size() == size) break;
        if (other == no_index || clusters.of_tet[other] != no_index) continue;
        clusters.of_tet[other] = cluster;
        grown.push_back(other);
      }
  }
  return clusters;
}

WeightedGraph graph_of(const TetNeighbours& neighbours, const TetClusters& clusters) {
  WeightedGraph graph;
  graph.vertex_weights.assign(clusters.count, 0);
  std::vector<std::pair<Index, Index>> pairs;  // of clusters, one for each face and direction
  for (Index t = 0; t < neighbours.size(); ++t) {
    const Index own = clusters.of_tet[t];
    ++graph.vertex_weights[own];
    for (const Index other : neighbours[t])
      if (other != no_index && clusters.of_tet[other] != own) pairs.emplace_back(own, clusters.of_tet[other]);
  }
  std::sort(pairs.begin(), pairs.end());
  std::size_t at = 0;
  graph.starts.push_back(0);
  for (Index cluster = 0; cluster < clusters.count; ++cluster) {
    while (at < pairs.size() && pairs[at].first == cluster) {
      const std::size_t begin = at;
      while (at < pairs.size() && pairs[at] == pairs[begin]) ++at;
      graph.neighbours.push_back(static_cast<std::int32_t>(pairs[begin].second));
      graph.edge_weights.push_back(static_cast<std::int32_t>(at - begin));
    }
    graph.starts.push_back(static_cast<std::int32_t>(graph.neighbours.size()));
  }
  return graph;
}

}  // namespace tetwright

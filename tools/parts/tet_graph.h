// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Tets beside each tet across its faces, in no particular order; no_index where there is none.
using TetNeighbours = std::vector<std::array<Index, 4>>;
TetNeighbours tet_neighbours(const TetMesh& mesh);

/// A graph with weights, as Scotch takes it: the neighbours of vertex v are at starts[v] to starts[v + 1].
struct WeightedGraph {
  std::vector<std::int32_t> starts, neighbours, edge_weights, vertex_weights;  ///< weights may be empty: 1
};

/// Some vertices of a graph, in ascending order, and the edges between them.
WeightedGraph subgraph(const WeightedGraph& graph, const std::vector<std::int32_t>& vertices);

/// The graph of the tets.
/// \pre fewer than 2^29 tets
WeightedGraph graph_of(const TetNeighbours& neighbours);

/// Cluster of each tet, numbered from 0.
struct TetClusters {
  std::vector<Index> of_tet;
  std::size_t count = 0;
};

/// Clusters of at most `size` tets that are connected by faces, grown from tet to tet in Morton order.
TetClusters cluster_tets(const TetMesh& mesh, const TetNeighbours& neighbours, std::size_t size);

/// The graph of the clusters: a vertex weighs its tets, an edge the faces between two clusters.
WeightedGraph graph_of(const TetNeighbours& neighbours, const TetClusters& clusters);

}  // namespace tetwright

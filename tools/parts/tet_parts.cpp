// SPDX-License-Identifier: Apache-2.0
#include "tetwright/tet_parts.h"

#include <algorithm>
#include <string>

#include "tetwright/error.h"
#include "tools/parts/part_balance.h"
#include "tools/parts/scotch_graph.h"
#include "tools/parts/tet_graph.h"

namespace tetwright {

namespace {

/// Larger meshes are divided by clusters, whose graph takes Scotch a fraction of the memory. The borders of
/// clusters of 16 tets have 1.3 times as many faces, of 64 tets 1.5 times (2.4 million tets, 8 parts), so
/// they are as small as the number of vertices allows.
constexpr std::size_t max_tets_of_graph = std::size_t{1} << 23;
constexpr std::size_t min_tets_of_cluster = 16, max_clusters = std::size_t{1} << 20;
/// Parts need this many clusters to have about the same size.
constexpr std::size_t min_clusters_of_part = 200;
/// Imbalance asked of Scotch, which does not always keep it.
constexpr double scotch_imbalance = 0.02;

/// Size of the clusters; 1: none.
std::size_t cluster_size(std::size_t tets, PartNumber parts) {
  if (tets <= max_tets_of_graph) return 1;
  const std::size_t wanted = std::max(min_tets_of_cluster, tets / max_clusters);
  return std::clamp<std::size_t>(tets / (min_clusters_of_part * parts), 1, wanted);
}

}  // namespace

TetPartition partition_tets(const TetMesh& mesh, PartNumber parts) {
  const std::size_t tets = mesh.tets.size();
  if (parts < 1 || parts > tets)
    throw UsageError("--parts " + std::to_string(parts) + ": the mesh has " + std::to_string(tets) +
                     " tets, and each part needs one; give a smaller number");
  TetPartition partition{.parts = parts, .part_of = {}};
  if (parts == 1) return partition;
  const TetNeighbours neighbours = tet_neighbours(mesh);
  const std::size_t size = cluster_size(tets, parts);
  if (size == 1) {
    partition.part_of = scotch_parts(graph_of(neighbours), parts, scotch_imbalance);
  } else {
    const TetClusters clusters = cluster_tets(mesh, neighbours, size);
    const std::vector<PartNumber> of_cluster =
        scotch_parts(graph_of(neighbours, clusters), parts, scotch_imbalance);
    partition.part_of.reserve(tets);
    for (const Index cluster : clusters.of_tet) partition.part_of.push_back(of_cluster[cluster]);
  }
  const auto most = static_cast<std::size_t>((1 + max_part_imbalance) * static_cast<double>(tets) / parts);
  const std::size_t largest = std::max(most, (tets + parts - 1) / parts);
  balance_parts(neighbours, largest, partition);
  if (size > 1) smooth_parts(neighbours, largest, partition);
  connect_parts(neighbours, largest, partition);
  return partition;
}

}  // namespace tetwright

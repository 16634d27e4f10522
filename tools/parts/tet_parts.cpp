// SPDX-License-Identifier: Apache-2.0
#include "tetwright/tet_parts.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "tetwright/error.h"
#include "tetwright/progress.h"
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

/// More parts are made of larger ones: Scotch takes 2.3 s for 128 parts of 573,452 tets, 4.6 s for 1,000 and
/// 80 s for 10,000; two levels take 6.3 s for these, and their borders have 4 % fewer faces.
constexpr PartNumber max_parts_at_once = 256;
/// Larger parts that are divided further have about this many each.
constexpr PartNumber parts_of_larger_one = 128;

/// Divides a graph by Scotch in one or several levels.
class GraphDivision {
 public:
  GraphDivision(std::size_t vertices, const Progress* progress)
      : progress_(progress), part_of_(vertices, 0) {}

  /// Divides the vertices of a graph into `parts` parts numbered from `first` on.
  /// \param names of the vertices, as indices of the result; empty: those of the graph
  void divide(const WeightedGraph& graph, const std::vector<Index>& names, PartNumber first,
              PartNumber parts) {
    if (progress_) progress_->throw_if_stopped();
    const auto name = [&](std::size_t vertex) { return names.empty() ? vertex : names[vertex]; };
    const std::size_t vertices = graph.starts.size() - 1;
    if (parts <= 1 || vertices <= 1) {
      for (std::size_t v = 0; v < vertices; ++v) part_of_[name(v)] = first;
      return;
    }
    const PartNumber larger =
        parts <= max_parts_at_once
            ? parts
            : std::min((parts + parts_of_larger_one - 1) / parts_of_larger_one, max_parts_at_once);
    std::vector<PartNumber> of_vertex = scotch_parts(graph, larger, scotch_imbalance);
    bool last = larger == parts;
    if (!last && std::count(of_vertex.begin(), of_vertex.end(), of_vertex[0]) == std::ssize(of_vertex)) {
      of_vertex = scotch_parts(graph, parts, scotch_imbalance);  // a further level would be the same
      last = true;
    }
    if (last) {
      for (std::size_t v = 0; v < vertices; ++v) part_of_[name(v)] = first + of_vertex[v];
      return;
    }
    std::vector<std::vector<std::int32_t>> members(larger);
    std::vector<std::uint64_t> weights(larger, 0);
    std::uint64_t total = 0, before = 0;
    for (std::size_t v = 0; v < vertices; ++v) {
      const auto weight =
          graph.vertex_weights.empty() ? 1 : static_cast<std::uint64_t>(graph.vertex_weights[v]);
      members[of_vertex[v]].push_back(static_cast<std::int32_t>(v));
      weights[of_vertex[v]] += weight;
      total += weight;
    }
    // Each gets parts in proportion to its weight, rounded such that the sum is right.
    const auto parts_up_to = [&](std::uint64_t weight) {
      return static_cast<PartNumber>((weight * parts + total / 2) / total);
    };
    for (PartNumber l = 0; l < larger; ++l) {
      const PartNumber begin = parts_up_to(before), end = parts_up_to(before += weights[l]);
      std::vector<Index> inner;
      inner.reserve(members[l].size());
      for (const std::int32_t v : members[l])
        inner.push_back(static_cast<Index>(name(static_cast<std::size_t>(v))));
      divide(subgraph(graph, members[l]), inner, first + std::min(begin, parts - 1), end - begin);
    }
  }

  std::vector<PartNumber> take() { return std::move(part_of_); }

 private:
  const Progress* progress_;
  std::vector<PartNumber> part_of_;
};

std::vector<PartNumber> parts_of_graph(const WeightedGraph& graph, PartNumber parts,
                                       const Progress* progress) {
  GraphDivision division(graph.starts.size() - 1, progress);
  division.divide(graph, {}, 0, parts);
  return division.take();
}

/// Size of the clusters; 1: none.
std::size_t cluster_size(std::size_t tets, PartNumber parts) {
  if (tets <= max_tets_of_graph) return 1;
  const std::size_t wanted = std::max(min_tets_of_cluster, tets / max_clusters);
  return std::clamp<std::size_t>(tets / (min_clusters_of_part * parts), 1, wanted);
}

}  // namespace

TetPartition partition_tets(const TetMesh& mesh, PartNumber parts, const Progress* progress) {
  const std::size_t tets = mesh.tets.size();
  if (parts < 1 || parts > tets)
    throw UsageError("--parts " + std::to_string(parts) + ": the mesh has " + std::to_string(tets) +
                     " tets, and each part needs one; give a smaller number");
  TetPartition partition{.parts = parts, .part_of = {}};
  if (parts == 1) return partition;
  const TetNeighbours neighbours = tet_neighbours(mesh);
  const std::size_t size = cluster_size(tets, parts);
  if (size == 1) {
    partition.part_of = parts_of_graph(graph_of(neighbours), parts, progress);
  } else {
    const TetClusters clusters = cluster_tets(mesh, neighbours, size);
    const std::vector<PartNumber> of_cluster =
        parts_of_graph(graph_of(neighbours, clusters), parts, progress);
    partition.part_of.reserve(tets);
    for (const Index cluster : clusters.of_tet) partition.part_of.push_back(of_cluster[cluster]);
  }
  if (progress) progress->throw_if_stopped();
  const auto most = static_cast<std::size_t>((1 + max_part_imbalance) * static_cast<double>(tets) / parts);
  const std::size_t largest = std::max(most, (tets + parts - 1) / parts);
  balance_parts(neighbours, largest, partition);
  if (size > 1) smooth_parts(neighbours, largest, partition);
  connect_parts(neighbours, largest, partition);
  return partition;
}

}  // namespace tetwright

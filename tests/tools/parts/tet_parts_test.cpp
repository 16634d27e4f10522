// SPDX-License-Identifier: Apache-2.0
#include "tetwright/tet_parts.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <variant>

#include "common/samples/samples.h"
#include "tests/common/small_meshes.h"
#include "tests/simplify/meshes.h"
#include "tetwright/error.h"
#include "tetwright/progress.h"
#include "tetwright/resources.h"
#include "tools/parts/part_balance.h"
#include "tools/parts/scotch_graph.h"
#include "tools/parts/tet_graph.h"

namespace tetwright::tet_parts_test {
namespace {

TetMesh block(int n) {
  return grid_mesh({n, n, n}, [](int, int, int) { return std::optional<MaterialTag>(1); });
}

TEST(TetParts, PartsAreEvenConnectedAndCutFewFaces) {
  const TetMesh mesh = block(16);
  for (const PartNumber parts : {2U, 8U, 27U}) {
    SCOPED_TRACE(parts);
    const TetPartition partition = partition_tets(mesh, parts);
    const PartitionStatistics statistics = partition_statistics(mesh, partition);
    EXPECT_LE(statistics.imbalance, max_part_imbalance);
    for (const PartSize& part : statistics.parts) {
      EXPECT_GT(part.tets, 0u);
      EXPECT_EQ(part.pieces, 1u);
    }
    // A cube of this many cells has six sides of two triangles for each cell.
    const double cells = 16.0 * 16 * 16 / parts;
    const double faces_of_cubes = 12 * std::cbrt(cells) * std::cbrt(cells) * parts / 2;
    EXPECT_LT(static_cast<double>(statistics.cut_faces), 1.5 * faces_of_cubes);
  }
}

TEST(TetParts, TheResultDoesNotDependOnThreads) {
  const TetMesh mesh = std::get<TetMesh>(make_sample("random-interior"));
  TetPartition one, two;
  with_threads(1, [&] { one = partition_tets(mesh, 7); });
  with_threads(2, [&] { two = partition_tets(mesh, 7); });
  EXPECT_EQ(one.part_of, two.part_of);
}

TEST(TetParts, ManyPartsAreEvenAndCutFewFacesToo) {
  const TetMesh mesh = block(16);
  for (const PartNumber parts : {257U, 300U, 999U}) {
    SCOPED_TRACE(parts);
    TetPartition partition, again;
    with_threads(1, [&] { partition = partition_tets(mesh, parts); });
    with_threads(2, [&] { again = partition_tets(mesh, parts); });
    EXPECT_EQ(partition.part_of, again.part_of);
    const PartitionStatistics statistics = partition_statistics(mesh, partition);
    const double tets = static_cast<double>(mesh.tets.size());
    const auto most =
        static_cast<std::size_t>(std::max((1 + max_part_imbalance) * tets / parts, std::ceil(tets / parts)));
    std::size_t pieces = 0;
    for (const PartSize& part : statistics.parts) {
      EXPECT_GE(part.tets, 1u);
      EXPECT_LE(part.tets, most);
      pieces += part.pieces;
    }
    EXPECT_LT(static_cast<double>(pieces), 1.1 * parts);
    const double cells = 16.0 * 16 * 16 / parts;
    EXPECT_LT(static_cast<double>(statistics.cut_faces),
              1.5 * 12 * std::cbrt(cells) * std::cbrt(cells) * parts / 2);
  }
}

TEST(TetParts, CancellationStopsThem) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW((void)partition_tets(block(2), 2, &progress), Interrupted);
}

TEST(TetClusters, ASubgraphKeepsWeightsAndInnerEdges) {
  // A square of the vertices 0 to 3 with a diagonal from 0 to 2.
  const WeightedGraph graph{.starts = {0, 3, 5, 8, 10},
                            .neighbours = {1, 2, 3, 0, 2, 0, 1, 3, 0, 2},
                            .edge_weights = {5, 6, 7, 5, 8, 6, 8, 9, 7, 9},
                            .vertex_weights = {1, 2, 3, 4}};
  const WeightedGraph part = subgraph(graph, {0, 2, 3});
  EXPECT_EQ(part.starts, (std::vector<std::int32_t>{0, 2, 4, 6}));
  EXPECT_EQ(part.neighbours, (std::vector<std::int32_t>{1, 2, 0, 2, 0, 1}));
  EXPECT_EQ(part.edge_weights, (std::vector<std::int32_t>{6, 7, 6, 9, 7, 9}));
  EXPECT_EQ(part.vertex_weights, (std::vector<std::int32_t>{1, 3, 4}));
}

TEST(TetParts, TheThreadKeepsItsProcessors) {
  cpu_set_t before, after;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  (void)partition_tets(block(4), 3);
  ASSERT_EQ(sched_getaffinity(0, sizeof after, &after), 0);
  EXPECT_TRUE(CPU_EQUAL(&before, &after));
}

TEST(TetParts, EveryPartHasATetUpToAsManyPartsAsTets) {
  const TetMesh mesh = block(2);
  for (PartNumber parts = 1; parts <= mesh.tets.size(); ++parts) {
    const PartitionStatistics statistics = partition_statistics(mesh, partition_tets(mesh, parts));
    const std::size_t most =
        std::max((mesh.tets.size() + parts - 1) / parts,
                 static_cast<std::size_t>(1.05 * static_cast<double>(mesh.tets.size()) / parts));
    for (const PartSize& part : statistics.parts) {
      EXPECT_GE(part.tets, 1u);
      EXPECT_LE(part.tets, most);
    }
  }
  EXPECT_THROW((void)partition_tets(mesh, static_cast<PartNumber>(mesh.tets.size() + 1)), UsageError);
  EXPECT_THROW((void)partition_tets(mesh, 0), UsageError);
}

TEST(TetParts, BodiesThatTouchNothingAreDividedToo) {
  TetMesh mesh = block(3);
  const TetMesh other = block(3);
  const auto first = static_cast<Index>(mesh.points.size());
  for (const Vec3& p : other.points) mesh.points.emplace_back(p + Vec3(100, 0, 0));
  for (const Tet& t : other.tets)
    mesh.tets.push_back({first + t[0], first + t[1], first + t[2], first + t[3]});
  mesh.materials.resize(mesh.tets.size(), 1);
  EXPECT_LE(partition_statistics(mesh, partition_tets(mesh, 3)).imbalance, max_part_imbalance);
}

TEST(TetParts, TetsWithoutNeighboursAreDivided) {
  const TetPartition partition = partition_tets(point_bridge(), 2);
  EXPECT_EQ(partition.part_of[0] + partition.part_of[1], 1u);
}

TEST(TetClusters, AreConnectedAndHaveAtMostTheirSize) {
  const TetMesh mesh = std::get<TetMesh>(make_sample("random-interior"));
  const TetNeighbours neighbours = tet_neighbours(mesh);
  const TetClusters clusters = cluster_tets(mesh, neighbours, 64);
  EXPECT_LT(clusters.count, mesh.tets.size() / 20);
  const PartitionStatistics statistics =
      partition_statistics(mesh, {static_cast<PartNumber>(clusters.count), clusters.of_tet});
  for (const PartSize& cluster : statistics.parts) {
    EXPECT_EQ(cluster.pieces, 1u);
    EXPECT_LE(cluster.tets, 64u);
  }
  const WeightedGraph graph = graph_of(neighbours, clusters);
  EXPECT_EQ(std::accumulate(graph.vertex_weights.begin(), graph.vertex_weights.end(), std::size_t{0}),
            mesh.tets.size());
  EXPECT_EQ(std::accumulate(graph.edge_weights.begin(), graph.edge_weights.end(), std::size_t{0}),
            2 * statistics.cut_faces);
  const std::vector<PartNumber> parts = scotch_parts(graph, 5, 0.02);
  std::vector<std::size_t> sizes(5, 0);
  for (std::size_t c = 0; c < parts.size(); ++c)
    sizes.at(parts[c]) += static_cast<std::size_t>(graph.vertex_weights[c]);
  EXPECT_LT(*std::max_element(sizes.begin(), sizes.end()), mesh.tets.size() / 4);
}

TEST(PartBalance, SmallPiecesGoToTheirNeighboursIfThereIsRoom) {
  const TetMesh mesh = block(6);
  const TetNeighbours neighbours = tet_neighbours(mesh);
  TetPartition partition{.parts = 2, .part_of = {}};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    partition.part_of.push_back(t < mesh.tets.size() / 2 ? 0 : 1);
  const TetPartition halves = partition;
  ASSERT_EQ(partition_statistics(mesh, halves).parts[0].pieces, 1u);
  partition.part_of[10] = 1;
  partition.part_of.back() = 0;
  TetPartition full = partition;
  connect_parts(neighbours, mesh.tets.size(), partition);
  EXPECT_EQ(partition.part_of, halves.part_of);
  connect_parts(neighbours, 0, full);
  EXPECT_EQ(full.part_of[10], 1u);
}

TEST(PartBalance, MovesAlongNeighboursAndFillsEmptyParts) {
  const TetMesh mesh = block(6);
  const TetNeighbours neighbours = tet_neighbours(mesh);
  // Slabs of very different sizes; the last part is empty.
  TetPartition partition{.parts = 5, .part_of = {}};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    partition.part_of.push_back(t < 50 ? 0 : t < 100 ? 1 : t < 150 ? 2 : 3);
  const std::size_t most = (mesh.tets.size() + 4) / 5;
  balance_parts(neighbours, most, partition);
  for (const PartSize& part : partition_statistics(mesh, partition).parts) {
    EXPECT_GE(part.tets, 1u);
    EXPECT_LE(part.tets, most);
  }
}

}  // namespace
}  // namespace tetwright::tet_parts_test

// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/mesh_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <variant>

#include "common/samples/samples.h"
#include "tests/common/small_meshes.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::mesh_pieces_test {
namespace {

TetMesh two_materials() {
  TetMesh mesh = std::get<TetMesh>(make_sample("two_materials"));
  mesh.interfaces = find_interfaces(mesh);
  return mesh;
}

/// Slabs across the longest axis, the first of which has a tet in two bits.
TetPartition slabs(const TetMesh& mesh, PartNumber parts) {
  TetPartition partition{.parts = parts, .part_of = {}};
  double low = mesh.points[0].x(), high = low;
  for (const Vec3& p : mesh.points) {
    low = std::min(low, p.x());
    high = std::max(high, p.x());
  }
  for (const Tet& tet : mesh.tets) {
    double x = 0;
    for (const Index p : tet) x += 0.25 * mesh.points[p].x();
    partition.part_of.push_back(
        std::min(parts - 1, static_cast<PartNumber>((x - low) / (high - low) * parts)));
  }
  return partition;
}

TEST(MeshPieces, GhostsAreTheTetsThatShareAPointAndNoOthers) {
  const TetMesh mesh = two_materials();
  const TetPartition partition = slabs(mesh, 5);
  const MeshPieces pieces(mesh, nullptr, partition);
  std::vector<PartNumber> owner_of_point(mesh.points.size(), partition.parts);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const Index p : mesh.tets[t]) owner_of_point[p] = std::min(owner_of_point[p], partition.of(t));
  std::size_t own = 0;
  for (PartNumber part = 0; part < partition.parts; ++part) {
    const MeshPiece piece = pieces.piece(part);
    std::set<Index> points;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      if (partition.of(t) == part) points.insert(mesh.tets[t].begin(), mesh.tets[t].end());
    std::set<std::uint64_t> expected,
        ghosts(piece.tet_numbers.begin() + static_cast<std::ptrdiff_t>(piece.own_tets),
               piece.tet_numbers.end());
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      if (partition.of(t) != part &&
          std::any_of(mesh.tets[t].begin(), mesh.tets[t].end(), [&](Index p) { return points.contains(p); }))
        expected.insert(t);
    EXPECT_EQ(ghosts, expected);
    for (std::size_t t = 0; t < piece.mesh.tets.size(); ++t) {
      EXPECT_EQ(piece.tet_owners[t], partition.of(piece.tet_numbers[t]));
      EXPECT_EQ(t < piece.own_tets, piece.tet_owners[t] == part);
      EXPECT_EQ(piece.mesh.materials[t], mesh.materials[piece.tet_numbers[t]]);
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_EQ(piece.node_numbers[piece.mesh.tets[t][k]], mesh.tets[piece.tet_numbers[t]][k]);
    }
    for (std::size_t p = 0; p < piece.mesh.points.size(); ++p) {
      EXPECT_EQ(piece.mesh.points[p], mesh.points[piece.node_numbers[p]]);
      EXPECT_EQ(piece.node_owners[p], owner_of_point[piece.node_numbers[p]]);
    }
    own += piece.own_tets;
  }
  EXPECT_EQ(own, mesh.tets.size());
}

TEST(MeshPieces, EveryInterfaceIsOwnedOnceAndKnownOnBothSides) {
  const TetMesh mesh = two_materials();
  const TetPartition partition = slabs(mesh, 4);
  const MeshPieces pieces(mesh, nullptr, partition);
  std::vector<int> owned(mesh.interfaces.size(), 0);
  for (PartNumber part = 0; part < partition.parts; ++part) {
    const MeshPiece piece = pieces.piece(part);
    for (std::size_t i = 0; i < piece.mesh.interfaces.size(); ++i) {
      owned[piece.face_numbers[i]] += piece.face_owners[i] == part;
      const InterfaceTriangle& t = piece.mesh.interfaces[i];
      EXPECT_EQ(t.pair(), mesh.interfaces[piece.face_numbers[i]].pair());
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(piece.node_numbers[t.ids[k]], mesh.interfaces[piece.face_numbers[i]].ids[k]);
    }
    for (const InterfaceSide& side : piece.sides) {
      std::set<Index> face, expected;
      for (const std::uint8_t k : tet_faces[side.face]) face.insert(piece.mesh.tets[side.tet][k]);
      for (const Index p : piece.mesh.interfaces[side.interface].ids) expected.insert(p);
      EXPECT_EQ(face, expected);
    }
  }
  EXPECT_TRUE(std::all_of(owned.begin(), owned.end(), [](int n) { return n == 1; }));
}

TEST(MeshPieces, MidsideNodesAndFieldsComeAlong) {
  TetMesh mesh = two_materials();
  MeshField whole{.name = "n", .integer = true, .values = {}}, real{.name = "x", .values = {}};
  for (std::size_t p = 0; p < mesh.points.size(); ++p) whole.values.push_back(static_cast<double>(p));
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) real.values.push_back(static_cast<double>(t) / 3);
  mesh.point_fields = {whole};
  mesh.cell_fields = {real};
  const MidsideNodes nodes = straight_midside_nodes(mesh);
  const TetPartition partition = slabs(mesh, 3);
  const MeshPieces pieces(mesh, &nodes, partition);
  EXPECT_EQ(pieces.whole().nodes, mesh.points.size() + nodes.points.size());
  for (PartNumber part = 0; part < partition.parts; ++part) {
    const MeshPiece piece = pieces.piece(part);
    ASSERT_TRUE(piece.midside);
    for (std::size_t t = 0; t < piece.mesh.tets.size(); ++t)
      for (std::size_t k = 0; k < 6; ++k)
        EXPECT_EQ(piece.node_numbers[piece.mesh.points.size() + piece.midside->of_tets[t][k]],
                  mesh.points.size() + nodes.of_tets[piece.tet_numbers[t]][k]);
    for (std::size_t i = 0; i < piece.mesh.interfaces.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(piece.node_numbers[piece.mesh.points.size() + piece.midside->of_faces[i][k]],
                  mesh.points.size() + nodes.of_faces[piece.face_numbers[i]][k]);
    for (std::size_t p = 0; p < piece.mesh.points.size(); ++p)
      EXPECT_EQ(piece.mesh.point_fields[0].values[p], static_cast<double>(piece.node_numbers[p]));
    for (std::size_t t = 0; t < piece.mesh.tets.size(); ++t)
      EXPECT_EQ(piece.mesh.cell_fields[0].values[t], static_cast<double>(piece.tet_numbers[t]) / 3);
  }
}

TEST(MeshPieces, OrderedMeshHasThePartsInSuccession) {
  const TetMesh mesh = two_materials();
  const MidsideNodes nodes = straight_midside_nodes(mesh);
  const TetPartition partition = slabs(mesh, 4);
  const OrderedMesh ordered = ordered_by_part(MeshPieces(mesh, &nodes, partition));
  const std::vector<double>& parts = ordered.mesh.cell_fields.at(0).values;
  EXPECT_TRUE(std::is_sorted(parts.begin(), parts.end()));
  EXPECT_TRUE(check_mesh(ordered.mesh).empty());
  const MidsideNodes expected = straight_midside_nodes(ordered.mesh);
  EXPECT_EQ(ordered.midside->edges, expected.edges);
  EXPECT_EQ(ordered.midside->of_tets, expected.of_tets);
  EXPECT_EQ(ordered.midside->of_faces, expected.of_faces);
  EXPECT_EQ(ordered.midside->points, expected.points);
}

TEST(TetPartition, StatisticsCountGhostsNeighboursCutFacesAndPieces) {
  const TetMesh one_face = two_tets();
  const PartitionStatistics cut = partition_statistics(one_face, {2, {1, 0}});
  EXPECT_EQ(cut.cut_faces, 1u);
  EXPECT_EQ(cut.imbalance, 0);
  for (const PartSize& part : cut.parts) {
    EXPECT_EQ(part.tets, 1u);
    EXPECT_EQ(part.points, 4u);
    EXPECT_EQ(part.ghosts, 1u);
    EXPECT_EQ(part.neighbours, 1u);
    EXPECT_EQ(part.pieces, 1u);
  }
  const PartitionStatistics whole = partition_statistics(point_bridge(), {});
  EXPECT_EQ(whole.parts.at(0).pieces, 2u);
  EXPECT_EQ(whole.parts.at(0).points, 7u);
  EXPECT_EQ(whole.parts.at(0).ghosts, 0u);
  const PartitionStatistics at_point = partition_statistics(point_bridge(), {2, {0, 1}});
  EXPECT_EQ(at_point.cut_faces, 0u);
  EXPECT_EQ(at_point.parts.at(1).ghosts, 1u);
}

}  // namespace
}  // namespace tetwright::mesh_pieces_test

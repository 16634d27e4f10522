// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/samples/samples.h"
#include "tests/common/small_meshes.h"
#include "tetwright/resources.h"

namespace tetwright::mesh_statistics_test {
namespace {

std::size_t total(const QualityHistogram& h) {
  std::size_t sum = 0;
  for (const auto& row : h.counts)
    for (std::size_t n : row) sum += n;
  return sum;
}

TEST(MeshStatistics, KuhnTets) {
  const MeshStatistics s = mesh_statistics(std::get<TetMesh>(make_sample("two_materials")), 0.3);
  EXPECT_EQ(s.tets, 768u);
  EXPECT_EQ(s.points, 9u * 5 * 5);
  EXPECT_EQ(s.materials.at(1).tets, 384u);
  EXPECT_NEAR(s.materials.at(2).volume, 1, 1e-14);
  EXPECT_NEAR(s.volume, 2, 1e-14);
  EXPECT_NEAR(s.min_dihedral, 45, 1e-12);
  EXPECT_NEAR(s.max_dihedral, 90, 1e-12);
  EXPECT_NEAR(s.min_solid_angle, 0.26179938779914943, 1e-14);  // pi / 12
  EXPECT_NEAR(s.mean_solid_angle, s.min_solid_angle, 1e-14);
  EXPECT_EQ(s.below_count, 768u);
  EXPECT_EQ(s.below_percent, 100);
  EXPECT_EQ(total(s.histogram), 768u);
  EXPECT_EQ(s.histogram.counts[10][16], 768u);  // 0.25 to 0.275 sr, 1 to sqrt(2) times the mean volume
}

TEST(MeshStatistics, InterfacesAndTheEdgesWhereTheyMeet) {
  TetMesh mesh = std::get<TetMesh>(make_sample("two_materials"));
  EXPECT_TRUE(mesh_statistics(mesh).interfaces.empty());
  mesh.interfaces = find_interfaces(mesh);
  const MeshStatistics s = mesh_statistics(mesh);
  ASSERT_EQ(s.interfaces.size(), 3u);
  // Two adjacent cubes of 4 x 4 x 4 cells, two triangles on each face of a cell.
  for (const auto& [pair, faces] : std::map<MaterialPair, int>{{{1, {}}, 5}, {{1, 2}, 1}, {{2, {}}, 5}}) {
    EXPECT_EQ(s.interfaces.at(pair).triangles, 32u * faces);
    EXPECT_NEAR(s.interfaces.at(pair).area, faces, 1e-13);
  }
  EXPECT_EQ(s.junction_edges, 16u);
}

TEST(MeshStatistics, TheRegularTetIsInTheLastAngleBin) {
  const TetMesh mesh{{{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}}, {{0, 1, 2, 3}}, {-4}, {}};
  const MeshStatistics s = mesh_statistics(mesh);
  EXPECT_NEAR(s.min_solid_angle, regular_solid_angle, 1e-14);
  EXPECT_EQ(s.below_count, 0u);
  EXPECT_EQ(s.histogram.counts[QualityHistogram::angle_bins - 1][16], 1u);
  EXPECT_NEAR(s.min_dihedral, 70.528779365509308, 1e-12);
}

TEST(MeshStatistics, FlatAndNegativeTetsCountAsZero) {
  TetMesh mesh = two_tets(2);
  mesh.tets[1] = {0, 1, 2, 4};
  mesh.points[4] = Vec3(1, 1, 0);
  const MeshStatistics s = mesh_statistics(mesh);
  EXPECT_EQ(s.min_solid_angle, 0);
  EXPECT_EQ(s.below_count, 1u);
  EXPECT_EQ(s.histogram.counts[0][0], 1u);
  EXPECT_EQ(s.materials.at(2).volume, 0);
}

TEST(MeshStatistics, TheSameForAnyThreads) {
  TetMesh mesh;
  for (int i = 0; i < 60000; ++i)
    mesh.points.push_back(Vec3(std::sqrt(i % 977), std::sqrt(i % 1009), std::sqrt(i % 499)));
  for (Index i = 0; i + 3 < mesh.points.size(); ++i) {
    mesh.tets.push_back({i, i + 1, i + 2, i + 3});
    mesh.materials.push_back(static_cast<MaterialTag>(i / 1000 % 3));
  }
  MeshStatistics s[2];
  for (unsigned threads : {1u, 4u}) {
    const ThreadLimit limit(threads);
    s[threads == 4] = mesh_statistics(mesh);
  }
  EXPECT_EQ(s[0].volume, s[1].volume);
  EXPECT_EQ(s[0].mean_solid_angle, s[1].mean_solid_angle);
  EXPECT_EQ(s[0].materials.at(2).volume, s[1].materials.at(2).volume);
  EXPECT_EQ(s[0].histogram.counts, s[1].histogram.counts);
  EXPECT_EQ(total(s[0].histogram), mesh.tets.size());
}

TEST(MeshStatistics, Empty) { EXPECT_EQ(mesh_statistics({}).tets, 0u); }

}  // namespace
}  // namespace tetwright::mesh_statistics_test

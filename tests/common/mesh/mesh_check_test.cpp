// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <gtest/gtest.h>

#include <limits>

#include "common/samples/samples.h"
#include "tests/common/small_meshes.h"
#include "tetwright/resources.h"

namespace tetwright::mesh_check_test {
namespace {

/// Names and counts, in order.
std::vector<std::pair<std::string, std::size_t>> found(const TetMesh& mesh) {
  std::vector<std::pair<std::string, std::size_t>> out;
  for (const MeshFinding& f : check_mesh(mesh)) out.emplace_back(mesh_finding_name(f), f.count);
  return out;
}
using Found = std::vector<std::pair<std::string, std::size_t>>;

TEST(MeshCheck, ValidMeshes) {
  EXPECT_EQ(found(one_tet()), Found{});
  EXPECT_EQ(found(two_tets()), Found{});
  EXPECT_EQ(found(two_tets(2)), Found{});
  for (const char* name : {"tet_cube", "two_materials", "layers"})
    EXPECT_EQ(found(std::get<TetMesh>(make_sample(name))), Found{}) << name;
}

TEST(MeshCheck, ArraysThatMakeNoSenseEndTheCheck) {
  EXPECT_EQ(found({}), (Found{{"materials_missing", 1}}));
  TetMesh mesh = one_tet();
  mesh.materials.clear();
  EXPECT_EQ(found(mesh), (Found{{"materials_missing", 1}}));
  mesh = two_tets();
  mesh.tets[1][2] = 5;
  EXPECT_EQ(found(mesh), (Found{{"index_out_of_range", 1}}));
  mesh = two_tets();
  mesh.points[1].y() = std::numeric_limits<double>::infinity();
  mesh.points[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(found(mesh), (Found{{"coordinates_not_finite", 2}}));
}

TEST(MeshCheck, UnusedPointsAreAWarning) {
  TetMesh mesh = one_tet();
  EXPECT_TRUE(is_valid(check_mesh(mesh)));
  mesh.points.push_back(Vec3(5, 5, 5));
  EXPECT_EQ(found(mesh), (Found{{"unused_points", 1}}));
  EXPECT_TRUE(is_valid(check_mesh(mesh)));
  std::swap(mesh.tets[0][0], mesh.tets[0][1]);
  EXPECT_EQ(found(mesh).size(), 2u);
  EXPECT_FALSE(is_valid(check_mesh(mesh)));
}

TEST(MeshCheck, PlacesAreNamed) {
  TetMesh mesh = two_tets();
  mesh.tets[1] = {0, 1, 2, 4};
  const std::vector<MeshFinding> findings = check_mesh(mesh);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, DiagnosticCode::inverted);
  EXPECT_EQ(mesh_finding_line(findings[0]), "inverted or flat tets (inverted): 1, at tet 1 (0 1 2 4)");
}

TEST(MeshCheck, FlatIsInverted) {
  TetMesh mesh = one_tet();
  mesh.points[3].z() = 0;
  const Found f = found(mesh);
  ASSERT_FALSE(f.empty());
  EXPECT_EQ(f[0], (std::pair<std::string, std::size_t>{"inverted", 1}));
  mesh.points[3].z() = 5e-324;
  EXPECT_EQ(found(mesh), Found{});
}

TEST(MeshCheck, UnusedPointsDegenerateAndDuplicateTets) {
  TetMesh mesh = one_tet();
  mesh.points.push_back({5, 5, 5});
  EXPECT_EQ(found(mesh), (Found{{"unused_points", 1}}));
  mesh = two_tets();
  mesh.tets.push_back({2, 1, 3, 0});  // the first one with its vertices in a different order
  mesh.materials.push_back(1);
  EXPECT_EQ(found(mesh)[0], (std::pair<std::string, std::size_t>{"duplicate_tets", 1}));
  mesh = two_tets();
  mesh.tets.push_back({0, 1, 1, 3});
  mesh.materials.push_back(1);
  EXPECT_EQ(found(mesh)[0], (std::pair<std::string, std::size_t>{"degenerate_tets", 1}));
}

TEST(MeshCheck, AFaceOfThreeTets) {
  TetMesh mesh = two_tets();
  mesh.points.push_back({0.2, 0.2, 2});
  mesh.tets.push_back({0, 1, 2, 5});
  mesh.materials.push_back(1);
  EXPECT_EQ(found(mesh)[0], (std::pair<std::string, std::size_t>{"face_over_shared", 1}));
}

TEST(MeshCheck, BridgesOfAnEdgeAndOfAPoint) {
  EXPECT_EQ(found(edge_bridge()), (Found{{"boundary_edges_not_two", 1}, {"point_star_split", 2}}));
  EXPECT_EQ(found(point_bridge()), (Found{{"boundary_points_non_manifold", 1}, {"point_star_split", 1}}));
}

TEST(MeshCheck, BoundaryThatIntersectsItself) {
  TetMesh mesh = one_tet();
  for (const Vec3& p : one_tet().points) mesh.points.push_back(p + Vec3(0.1, 0.1, 0.1));
  mesh.tets.push_back({4, 5, 6, 7});
  mesh.materials.push_back(1);
  const std::vector<MeshFinding> findings = check_mesh(mesh);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, DiagnosticCode::self_intersections);
  EXPECT_EQ(findings[0].count, 3u);  // the far face of the first meets the three near faces of the second
  EXPECT_TRUE(check_mesh(mesh, {.self_intersections = false}).empty());
}

TEST(MeshCheck, TheSameForAnyThreads) {
  TetMesh mesh = std::get<TetMesh>(make_sample("layers"));
  for (std::size_t t = 0; t < mesh.tets.size(); t += 97) std::swap(mesh.tets[t][0], mesh.tets[t][1]);
  for (std::size_t p = 0; p < mesh.points.size(); p += 31) mesh.points[p] *= 1.3;
  std::vector<std::string> lines[2];
  for (unsigned threads : {1u, 4u}) {
    const ThreadLimit limit(threads);
    for (const MeshFinding& f : check_mesh(mesh)) lines[threads == 4].push_back(mesh_finding_line(f));
  }
  EXPECT_EQ(lines[0], lines[1]);
  EXPECT_GE(lines[0].size(), 2u);
}

}  // namespace
}  // namespace tetwright::mesh_check_test

// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <set>
#include <string>

#include "common/geometry/predicates.h"
#include "common/random.h"
#include "tests/common/small_meshes.h"
#include "tests/simplify/meshes.h"
#include "tetwright/resources.h"
#include "tetwright/surface_mesh.h"

namespace tetwright::import_cleanup_test {
namespace {

int sign(const TetMesh& mesh, const Tet& t) {
  return orient3d(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
}

void expect_all_positive(const TetMesh& mesh) {
  for (const Tet& t : mesh.tets) ASSERT_EQ(sign(mesh, t), 1);
}

void turn(Tet& t) { std::swap(t[2], t[3]); }

/// Gives every tet its own points.
TetMesh soup_of(const TetMesh& mesh) {
  TetMesh soup = mesh;
  soup.points.clear();
  for (Tet& t : soup.tets)
    for (Index& p : t) {
      soup.points.push_back(mesh.points[p]);
      p = static_cast<Index>(soup.points.size() - 1);
    }
  return soup;
}

void number_fields(TetMesh& mesh) {
  mesh.point_fields = {{"number", 2, true, std::vector<double>(2 * mesh.points.size())}};
  std::iota(mesh.point_fields[0].values.begin(), mesh.point_fields[0].values.end(), 0.0);
  mesh.cell_fields = {{"number", 1, true, std::vector<double>(mesh.tets.size())}};
  std::iota(mesh.cell_fields[0].values.begin(), mesh.cell_fields[0].values.end(), 0.0);
}

TEST(ImportCleanup, NothingIsTouchedWhereAllIsFine) {
  TetMesh mesh = grid_mesh(3);
  jitter(mesh, 1);
  number_fields(mesh);
  mesh.interfaces = {{{0, 1, 2}, 1, {}}};
  mesh.points.emplace_back(mesh.points[0]);  // unused
  mesh.points.emplace_back(-0.0, 0.0, -0.0);
  const TetMesh before = mesh;
  const ImportCleanupReport report = make_coherent(mesh);
  EXPECT_EQ(report.merged_points + report.removed_tets + report.turned_tets + report.inverted_tets, 0u);
  EXPECT_TRUE(report.first_inverted.empty());
  EXPECT_EQ(mesh.tets, before.tets);
  EXPECT_EQ(mesh.materials, before.materials);
  EXPECT_EQ(mesh.interfaces, before.interfaces);
  EXPECT_EQ(mesh.point_fields, before.point_fields);
  EXPECT_EQ(mesh.cell_fields, before.cell_fields);
  ASSERT_EQ(mesh.points.size(), before.points.size());
  EXPECT_EQ(std::memcmp(mesh.points.data(), before.points.data(), mesh.points.size() * sizeof(Vec3)), 0);
}

TEST(ImportCleanup, AllInverted) {
  TetMesh mesh = grid_mesh(3);
  jitter(mesh, 2);
  const std::vector<Tet> positive = mesh.tets;
  mesh.interfaces = {{{0, 1, 2}, 1, {}}};
  for (Tet& t : mesh.tets) turn(t);
  const ImportCleanupReport report = make_coherent(mesh);
  EXPECT_EQ(report.turned_tets, mesh.tets.size());
  EXPECT_EQ(report.inverted_tets, 0u);
  EXPECT_EQ(mesh.tets, positive);
  EXPECT_TRUE(mesh.interfaces.empty());
}

TEST(ImportCleanup, SomeInvertedAndAnyThreads) {
  for (const std::uint32_t every : {2u, 3u, 10u}) {
    const TetMesh grid = grid_mesh(12);
    TetMesh mesh = grid;
    Random random(every);
    std::size_t turned = 0;
    for (Tet& t : mesh.tets)
      if (random.below(every) == 0) {
        turn(t);
        ++turned;
      }
    for (unsigned threads : {1u, 4u}) {
      const ThreadLimit limit(threads);
      TetMesh copy = mesh;
      const ImportCleanupReport report = make_coherent(copy);
      EXPECT_EQ(report.turned_tets, turned);
      EXPECT_EQ(copy.tets, grid.tets);
    }
  }
}

TEST(ImportCleanup, PartsHaveSensesOfTheirOwn) {
  TetMesh mesh = grid_mesh({5, 2, 2}, [](int x, int, int) -> std::optional<MaterialTag> {
    if (x == 2) return {};
    return 1;
  });
  const std::vector<Tet> positive = mesh.tets;
  std::size_t turned = 0;
  for (Tet& t : mesh.tets)
    if (mesh.points[t[0]].x() >= 3) {
      turn(t);
      ++turned;
    }
  ASSERT_EQ(turned, mesh.tets.size() / 2);
  EXPECT_EQ(make_coherent(mesh).turned_tets, turned);
  EXPECT_EQ(mesh.tets, positive);
}

TEST(ImportCleanup, SoupOfAGrid) {
  TetMesh grid = grid_mesh(3);
  for (Vec3& p : grid.points) p -= Vec3(1, 1, 1);
  TetMesh soup = soup_of(grid);
  Random random(3);
  for (Vec3& p : soup.points)
    for (double& x : p)
      if (x == 0 && random.below(2)) x = -0.0;
  number_fields(soup);
  for (bool inverted : {false, true}) {
    TetMesh mesh = soup;
    if (inverted) turn(mesh.tets[7]);
    mesh.interfaces = {{{0, 1, 2}, 1, {}}};
    const ImportCleanupReport report = make_coherent(mesh);
    EXPECT_EQ(report.merged_points, soup.points.size() - 64);
    EXPECT_EQ(report.turned_tets, inverted ? 1u : 0u);
    EXPECT_EQ(report.inverted_tets, 0u);
    EXPECT_TRUE(mesh.interfaces.empty());
    ASSERT_EQ(mesh.points.size(), 64u);
    // grid_mesh numbers points in the order in which tets use them first, as merging does.
    EXPECT_EQ(mesh.points, grid.points);
    EXPECT_EQ(mesh.tets, grid.tets);
    ASSERT_EQ(mesh.point_fields[0].values.size(), 128u);
    for (std::size_t p = 0; p < 64; ++p) {
      const auto first = static_cast<std::size_t>(mesh.point_fields[0].values[2 * p]) / 2;
      EXPECT_EQ(soup.points[first], mesh.points[p]);
      EXPECT_EQ(mesh.point_fields[0].values[2 * p + 1], static_cast<double>(2 * first + 1));
      for (std::size_t q = 0; q < first; ++q) ASSERT_NE(soup.points[q], mesh.points[p]);
    }
  }
}

TEST(ImportCleanup, PatchesStayWithTheirFaces) {
  TetMesh soup = soup_of(grid_mesh(2));
  turn(soup.tets[3]);
  soup.interfaces = find_interfaces(soup);
  const std::size_t faces = soup.interfaces.size();
  for (InterfaceTriangle& t : soup.interfaces)
    t.patch =
        soup.points[t.ids[0]].x() == 0 && soup.points[t.ids[1]].x() == 0 && soup.points[t.ids[2]].x() == 0;
  soup.interfaces[faces / 2].patch = 2;  // inside the merged mesh
  soup.patch_groups[{{1, std::nullopt}, 1}] = {0, "left"};
  const ImportCleanupReport report = make_coherent(soup);
  ASSERT_LT(soup.interfaces.size(), faces);
  EXPECT_EQ(report.lost_faces, 1u);
  for (const InterfaceTriangle& t : soup.interfaces)
    EXPECT_EQ(t.patch, soup.points[t.ids[0]].x() == 0 && soup.points[t.ids[1]].x() == 0 &&
                           soup.points[t.ids[2]].x() == 0);
  EXPECT_EQ(soup.patch_groups.size(), 1u);
}

// Soups of pairs of touching tets of two materials; each pair has a different patch on its common face.
TEST(ImportCleanup, MorePatchesThanNumbersEndAtOnce) {
  constexpr int pairs = 0xffff;
  TetMesh soup;
  for (int i = 0; i <= pairs; ++i) {
    const double x = 10.0 * i;
    for (const double apex : {1.0, -1.0}) {
      const auto first = static_cast<Index>(soup.points.size());
      for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, apex)})
        soup.points.push_back(p + Vec3(x, 0, 0));
      soup.tets.push_back({first, first + 1, first + 2, first + 3});
      if (apex < 0) std::swap(soup.tets.back()[0], soup.tets.back()[1]);
      soup.materials.push_back(apex > 0 ? 1 : 2);
      InterfaceTriangle t;
      t.ids = {first, first + 1, first + 2};
      t.material = apex > 0 ? 1 : 2;
      // All faces of the first material have different numbers; the last pair has only the second material's
      // number.
      t.patch = static_cast<std::uint16_t>(apex > 0 ? (i < pairs ? i + 1 : 0) : i < pairs ? 0 : 1);
      if (t.patch == 0) continue;
      soup.interfaces.push_back(t);
      soup.patch_groups[{{t.material, std::nullopt}, t.patch}] = {i + 1, ""};
    }
  }
  const ImportCleanupReport report = make_coherent(soup);
  EXPECT_EQ(report.lost_faces, 1u);
  EXPECT_EQ(soup.patch_groups.size(), static_cast<std::size_t>(pairs));
}

TEST(ImportCleanup, PatchesThatComeToLieBetweenMaterialsKeepTheirGroups) {
  TetMesh mesh = grid_mesh(2);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3 centre = Vec3::Zero();
    for (const Index p : mesh.tets[t]) centre += mesh.points[p] / 4;
    mesh.materials[t] = centre.x() < 1 ? 1 : 2;
  }
  TetMesh soup = soup_of(mesh);
  soup.interfaces = find_interfaces(soup);
  // Both sides of the interface, one of which remains, are boundary patches with the same number.
  std::size_t between = 0;
  for (InterfaceTriangle& t : soup.interfaces) {
    t.patch = std::all_of(t.ids.begin(), t.ids.end(), [&](Index p) { return soup.points[p].x() == 1; });
    between += t.patch;
  }
  ASSERT_GT(between, 0u);
  soup.patch_groups[{{1, std::nullopt}, 1}] = {0, "left"};
  soup.patch_groups[{{2, std::nullopt}, 1}] = {0, "right"};
  EXPECT_EQ(make_coherent(soup).lost_faces, between / 2);  // the names of one of the sides
  std::set<std::string> names;
  std::size_t kept = 0;
  for (const InterfaceTriangle& t : soup.interfaces) {
    if (t.patch == 0) continue;
    ++kept;
    const auto group = soup.patch_groups.find({t.pair(), t.patch});
    ASSERT_NE(group, soup.patch_groups.end());
    EXPECT_EQ(t.other, MaterialOrOutside(2));
    names.insert(group->second.name);
  }
  EXPECT_EQ(kept, between / 2);
  EXPECT_TRUE(names == std::set<std::string>{"left"} || names == std::set<std::string>{"right"});
}

TEST(ImportCleanup, UnusedPointsOfASoupStay) {
  TetMesh mesh = soup_of(two_tets());
  mesh.points.insert(mesh.points.begin(), 2, mesh.points[0]);
  for (Tet& t : mesh.tets)
    for (Index& p : t) p += 2;
  EXPECT_EQ(make_coherent(mesh).merged_points, 3u);
  EXPECT_EQ(mesh.points.size(), 7u);
  EXPECT_EQ(mesh.tets, (std::vector<Tet>{{2, 3, 4, 5}, {2, 4, 3, 6}}));
}

TEST(ImportCleanup, PointsOfAConnectedMeshNeverMerge) {
  // A crack: the second half duplicates the points of the first.
  TetMesh mesh = grid_mesh(2), half = mesh;
  for (Vec3& p : half.points) p.x() += 2;
  const auto offset = static_cast<Index>(mesh.points.size());
  for (Tet t : half.tets) {
    for (Index& p : t) p += offset;
    mesh.tets.push_back(t);
    mesh.materials.push_back(1);
  }
  mesh.points.insert(mesh.points.end(), half.points.begin(), half.points.end());
  turn(mesh.tets[0]);
  const ImportCleanupReport report = make_coherent(mesh);
  EXPECT_EQ(report.merged_points, 0u);
  EXPECT_EQ(report.turned_tets, 1u);
  EXPECT_EQ(mesh.points.size(), 2 * offset);
}

TEST(ImportCleanup, OneTetIsNoSoup) {
  TetMesh mesh = one_tet();
  mesh.points[3] = mesh.points[0];
  const ImportCleanupReport report = make_coherent(mesh);
  EXPECT_EQ(report.merged_points, 0u);
  EXPECT_EQ(report.inverted_tets, 1u);
  EXPECT_EQ(report.first_inverted, std::vector<Index>{0});
}

TEST(ImportCleanup, TetsWithARepeatedVertexAreTakenOut) {
  TetMesh mesh = grid_mesh({2, 2, 2}, [](int x, int, int) { return std::optional<MaterialTag>(x); });
  const TetMesh grid = mesh;
  mesh.tets.insert(mesh.tets.begin() + 5, {3, 1, 3, 2});
  mesh.materials.insert(mesh.materials.begin() + 5, 9);
  mesh.tets.push_back({4, 4, 4, 4});
  mesh.materials.push_back(9);
  mesh.interfaces = {{{0, 1, 2}, 1, {}}};
  number_fields(mesh);
  const ImportCleanupReport report = make_coherent(mesh);
  EXPECT_EQ(report.removed_tets, 2u);
  EXPECT_EQ(report.turned_tets, 0u);
  EXPECT_EQ(report.inverted_tets, 0u);
  EXPECT_EQ(mesh.tets, grid.tets);
  EXPECT_EQ(mesh.materials, grid.materials);
  EXPECT_TRUE(mesh.interfaces.empty());
  ASSERT_EQ(mesh.cell_fields[0].values.size(), grid.tets.size());
  EXPECT_EQ(mesh.cell_fields[0].values[4], 4);
  EXPECT_EQ(mesh.cell_fields[0].values[5], 6);
  EXPECT_EQ(mesh.point_fields[0].values.size(), 2 * grid.points.size());
}

TEST(ImportCleanup, ATrulyNegativeTetStaysAndIsReported) {
  TetMesh mesh = grid_mesh(4);
  // The point at (2, 2, 2) moves out of its star, which inverts some of the tets.
  const auto at = std::find(mesh.points.begin(), mesh.points.end(), Vec3(2, 2, 2));
  ASSERT_NE(at, mesh.points.end());
  *at = Vec3(3.5, 3, 3.25);
  std::vector<Index> negative;
  for (Index t = 0; t < mesh.tets.size(); ++t)
    if (sign(mesh, mesh.tets[t]) <= 0) negative.push_back(t);
  ASSERT_GT(negative.size(), 3u);
  const TetMesh folded = mesh;
  for (bool turned : {false, true}) {
    mesh = folded;
    if (turned)
      for (Tet& t : mesh.tets) turn(t);
    const ImportCleanupReport report = make_coherent(mesh);
    EXPECT_EQ(report.turned_tets, turned ? mesh.tets.size() : 0);
    EXPECT_EQ(mesh.tets, folded.tets);
    EXPECT_EQ(report.inverted_tets, negative.size());
    EXPECT_EQ(report.first_inverted, std::vector<Index>(negative.begin(), negative.begin() + 3));
  }
}

TEST(ImportCleanup, AFaceOfThreeTetsConnectsNothing) {
  TetMesh mesh = two_tets();
  mesh.points.emplace_back(0.3, 0.3, 2);
  mesh.tets.push_back({0, 2, 1, 5});  // negative
  mesh.materials.push_back(1);
  turn(mesh.tets[1]);
  const ImportCleanupReport report = make_coherent(mesh);
  EXPECT_EQ(report.turned_tets, 2u);
  EXPECT_EQ(report.inverted_tets, 0u);
  expect_all_positive(mesh);
}

TEST(ImportCleanup, ATetThatIsThereTwice) {
  TetMesh mesh = one_tet();
  turn(mesh.tets[0]);
  mesh.tets.push_back(mesh.tets[0]);
  mesh.materials.push_back(2);
  // Both lie on the same side of all their faces, so one must stay inverted.
  const ImportCleanupReport report = make_coherent(mesh);
  EXPECT_EQ(report.turned_tets, 1u);
  EXPECT_EQ(report.inverted_tets, 1u);
  EXPECT_EQ(report.first_inverted, std::vector<Index>{1});
}

TEST(ImportCleanup, FlatTetsFollowTheirNeighbours) {
  TetMesh mesh = two_tets();
  mesh.points[4] = Vec3(0.2, 0.2, 0);  // the second tet is flat now
  turn(mesh.tets[0]);
  const ImportCleanupReport report = make_coherent(mesh);
  EXPECT_EQ(report.turned_tets, 1u);
  EXPECT_EQ(report.inverted_tets, 1u);
  EXPECT_EQ(mesh.tets, two_tets().tets);
}

TEST(ImportCleanup, CoordinatesWhoseVolumesOverflow) {
  for (const double scale : {1e308, 1e-300}) {
    TetMesh mesh = grid_mesh(2);
    double largest = 0;
    for (const Vec3& p : mesh.points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
    for (Vec3& p : mesh.points) p *= scale / largest;
    for (Tet& t : mesh.tets) turn(t);
    EXPECT_EQ(make_coherent(mesh).turned_tets, mesh.tets.size()) << scale;
  }
}

TEST(ImportCleanup, NoTets) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(make_coherent(mesh).merged_points, 0u);
  EXPECT_EQ(mesh.points.size(), 2u);
}

}  // namespace
}  // namespace tetwright::import_cleanup_test

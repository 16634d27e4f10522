// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "common/random.h"
#include "tests/common/small_meshes.h"
#include "tests/simplify/meshes.h"
#include "tetwright/resources.h"

namespace tetwright::field_transfer_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double linear(const Vec3& p) { return 1.5 + 2 * p.x() - 3 * p.y() + 0.25 * p.z(); }

MeshField sampled(const TetMesh& mesh, double (*f)(const Vec3&)) {
  MeshField field{"sampled", 1, false, {}};
  for (const Vec3& p : mesh.points) field.values.push_back(f(p));
  return field;
}

/// Points in [low, high)^3, without tets.
TetMesh random_points(std::uint64_t seed, std::size_t count, double low, double high) {
  TetMesh mesh;
  Random random(seed);
  for (std::size_t i = 0; i < count; ++i)
    mesh.points.emplace_back(low + (high - low) * random.uniform(), low + (high - low) * random.uniform(),
                             low + (high - low) * random.uniform());
  return mesh;
}

/// A cube of n^3 grid cells, jittered except on its sides.
TetMesh cube(int n, std::uint64_t seed) {
  TetMesh mesh = grid_mesh(n);
  const TetMesh straight = mesh;
  jitter(mesh, seed, 0.2);
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    const Vec3& s = straight.points[p];
    if (s.minCoeff() == 0 || s.maxCoeff() == n) mesh.points[p] = s;
  }
  return mesh;
}

TEST(FieldTransfer, NoFieldsAreNoFields) {
  const TetMesh before = two_tets();
  TetMesh after = one_tet();
  after.point_fields = {{"old", 1, false, {1, 2, 3, 4}}};
  after.cell_fields = {{"old", 1, false, {1}}};
  transfer_fields(before, after);
  EXPECT_TRUE(after.point_fields.empty());
  EXPECT_TRUE(after.cell_fields.empty());
}

TEST(FieldTransfer, ALinearFieldIsReproduced) {
  TetMesh before = cube(6, 1);
  before.point_fields = {sampled(before, linear)};
  TetMesh after = random_points(2, 5000, 0, 6);
  transfer_fields(before, after);
  ASSERT_EQ(after.point_fields.size(), 1u);
  EXPECT_EQ(after.point_fields[0].name, "sampled");
  ASSERT_EQ(after.point_fields[0].values.size(), after.points.size());
  for (std::size_t p = 0; p < after.points.size(); ++p)
    ASSERT_NEAR(after.point_fields[0].values[p], linear(after.points[p]), 1e-12);
}

TEST(FieldTransfer, LinearOnFacesAndEdgesToo) {
  TetMesh before = grid_mesh(4);
  before.point_fields = {sampled(before, linear)};
  TetMesh after;
  for (int z = 0; z <= 8; ++z)
    for (int y = 0; y <= 8; ++y)
      for (int x = 0; x <= 8; ++x) after.points.emplace_back(x / 2.0, y / 2.0, z / 2.0);
  transfer_fields(before, after);
  for (std::size_t p = 0; p < after.points.size(); ++p)
    ASSERT_NEAR(after.point_fields[0].values[p], linear(after.points[p]), 1e-12);
}

TEST(FieldTransfer, ConstantsStayToTheBit) {
  TetMesh before = cube(4, 3);
  before.point_fields = {{"c", 1, false, std::vector<double>(before.points.size(), 0.1)}};
  TetMesh after = random_points(4, 2000, -1, 5);
  transfer_fields(before, after);
  for (const double v : after.point_fields[0].values) ASSERT_EQ(v, 0.1);
}

TEST(FieldTransfer, ThreeComponents) {
  TetMesh before = cube(3, 5);
  MeshField place{"place", 3, false, {}};
  for (const Vec3& p : before.points) place.values.insert(place.values.end(), p.begin(), p.end());
  before.point_fields = {sampled(before, linear), place};
  TetMesh after = random_points(6, 500, 0, 3);
  transfer_fields(before, after);
  ASSERT_EQ(after.point_fields.size(), 2u);
  EXPECT_EQ(after.point_fields[1].components, 3);
  for (std::size_t p = 0; p < after.points.size(); ++p)
    for (int k = 0; k < 3; ++k)
      ASSERT_NEAR(after.point_fields[1].values[3 * p + static_cast<std::size_t>(k)], after.points[p][k],
                  1e-12);
}

TEST(FieldTransfer, EqualCoordinatesKeepTheirValues) {
  TetMesh before = cube(4, 7);
  Random random(8);
  MeshField noise{"noise", 2, false, std::vector<double>(2 * before.points.size())};
  for (double& v : noise.values) v = random.uniform() * 1e9;
  before.point_fields = {noise};
  TetMesh after = before;
  std::reverse(after.points.begin(), after.points.end());
  for (Vec3& p : after.points)
    for (double& x : p)
      if (x == 0) x = -0.0;
  transfer_fields(before, after);
  const std::size_t n = before.points.size();
  for (std::size_t p = 0; p < n; ++p)
    for (std::size_t k = 0; k < 2; ++k)
      ASSERT_EQ(after.point_fields[0].values[2 * p + k], noise.values[2 * (n - 1 - p) + k]);
}

TEST(FieldTransfer, IntegersAreThoseOfTheNearestVertexByWeight) {
  TetMesh before = one_tet();
  before.tets[0] = {1, 0, 3, 2};
  before.point_fields = {{"id", 1, true, {10, 11, 12, 13}}};
  TetMesh after;
  after.points = {{0.1, 0.1, 0.1}, {0.6, 0.1, 0.1},    {0.1, 0.6, 0.1},
                  {0.2, 0.1, 0.6}, {0.25, 0.25, 0.25},  // all weights equal: the smallest index
                  {0.5, 0.5, -1}};                      // outside, in the middle of the edge from 1 to 2
  transfer_fields(before, after);
  EXPECT_TRUE(after.point_fields[0].integer);
  EXPECT_EQ(after.point_fields[0].values, (std::vector<double>{10, 11, 12, 13, 10, 11}));
}

TEST(FieldTransfer, PointsOutsideTakeTheNearestPlace) {
  TetMesh before = cube(5, 9);
  before.point_fields = {sampled(before, linear)};
  TetMesh after = random_points(10, 3000, -4, 9);
  after.points.emplace_back(1e6, -1e6, 2.5);
  transfer_fields(before, after);
  for (std::size_t p = 0; p < after.points.size(); ++p) {
    const Vec3 nearest = after.points[p].cwiseMax(Vec3::Zero()).cwiseMin(Vec3::Constant(5));
    ASSERT_NEAR(after.point_fields[0].values[p], linear(nearest), 1e-11) << after.points[p].transpose();
  }
}

TEST(FieldTransfer, InvertedAndFlatTets) {
  TetMesh before = cube(4, 11);
  before.point_fields = {sampled(before, linear)};
  Random random(12);
  for (Tet& t : before.tets)
    if (random.below(2)) std::swap(t[0], t[1]);
  // Flat tets with different values, which must not appear at points that another tet contains.
  const auto n = static_cast<Index>(before.points.size());
  before.points.insert(before.points.end(), {{1, 1, 2.125}, {3, 1, 2.125}, {1, 3, 2.125}, {3, 3, 2.125}});
  before.points.insert(before.points.end(), {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}});
  for (int k = 0; k < 7; ++k) before.point_fields[0].values.push_back(1e9);
  before.tets.insert(before.tets.begin(), {n, n + 1, n + 2, n + 3});
  before.tets.insert(before.tets.begin(), {n + 4, n + 5, n + 6, n + 4});
  before.materials.resize(before.tets.size(), 1);
  TetMesh after = random_points(13, 3000, 0, 4);
  after.points.emplace_back(1.75, 1.5, 2.125);
  transfer_fields(before, after);
  for (std::size_t p = 0; p < after.points.size(); ++p)
    ASSERT_NEAR(after.point_fields[0].values[p], linear(after.points[p]), 1e-12);
}

TEST(FieldTransfer, FlatTetsAloneAreNearest) {
  TetMesh before;
  before.points = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}};
  before.tets = {{0, 1, 2, 3}};
  before.materials = {1};
  before.point_fields = {{"x", 1, false, {0, 2, 0, 2}}};
  before.cell_fields = {{"c", 1, false, {7}}};
  TetMesh after = one_tet();
  after.points = {{0.5, 0.5, 1}, {1.5, 1, -1}, {-1, 1, 0}, {1.25, 0.25, 0}};
  transfer_fields(before, after);
  const std::vector<double>& x = after.point_fields[0].values;
  EXPECT_NEAR(x[0], 0.5, 1e-15);
  EXPECT_NEAR(x[1], 1.5, 1e-15);
  EXPECT_EQ(x[2], 0);
  EXPECT_NEAR(x[3], 1.25, 1e-15);
  EXPECT_EQ(after.cell_fields[0].values, std::vector<double>{7});
  // A tet degenerated to a segment, and one degenerated to a point.
  before.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 0, 0}};
  transfer_fields(before, after);
  for (const double v : after.point_fields[0].values) EXPECT_TRUE(0 <= v && v <= 2) << v;
  before.points.assign(4, Vec3(1, 1, 1));
  transfer_fields(before, after);
  for (const double v : after.point_fields[0].values) EXPECT_TRUE(v == 0 || v == 2);
}

TEST(FieldTransfer, CellConstantsStayWithTheirMaterial) {
  const auto halves = [](int n) {
    return grid_mesh({n, n, n},
                     [n](int x, int, int) { return std::optional<MaterialTag>(x < n / 2 ? -4 : 9); });
  };
  TetMesh before = halves(6);
  before.cell_fields = {{"density", 1, false, {}}, {"id", 1, true, {}}};
  for (const MaterialTag m : before.materials) {
    before.cell_fields[0].values.push_back(m == 9 ? 0.1 : 7800.3);
    before.cell_fields[1].values.push_back(m);
  }
  TetMesh after = halves(4);
  for (Vec3& p : after.points) {
    p *= 1.5;
    p.x() += 0.9;  // so that many centroids are in a tet of the other material
  }
  transfer_fields(before, after);
  for (std::size_t t = 0; t < after.tets.size(); ++t) {
    ASSERT_EQ(after.cell_fields[0].values[t], after.materials[t] == 9 ? 0.1 : 7800.3);
    ASSERT_EQ(after.cell_fields[1].values[t], after.materials[t]);
  }
  EXPECT_TRUE(after.cell_fields[1].integer);
}

TEST(FieldTransfer, CellsTakeFromTheTetThatHoldsTheirCentroid) {
  TetMesh before = cube(4, 14);
  before.cell_fields = {{"number", 2, true, {}}};
  for (std::size_t t = 0; t < before.tets.size(); ++t) {
    before.materials[t] = static_cast<MaterialTag>(t % 3);
    before.cell_fields[0].values.push_back(static_cast<double>(t));
    before.cell_fields[0].values.push_back(nan);
  }
  TetMesh after = before;
  after.tets.insert(after.tets.end(), before.tets.begin(), before.tets.end());
  after.materials.resize(after.tets.size(), 77);  // not in `before`: takes values from any
  transfer_fields(before, after);
  for (std::size_t t = 0; t < after.tets.size(); ++t) {
    ASSERT_EQ(after.cell_fields[0].values[2 * t], static_cast<double>(t % before.tets.size()));
    ASSERT_TRUE(std::isnan(after.cell_fields[0].values[2 * t + 1]));
  }
}

TEST(FieldTransfer, TheNearestTetOfAMaterial) {
  TetMesh before = cube(4, 15);
  before.cell_fields = {{"number", 1, true, {}}};
  Random random(16);
  for (std::size_t t = 0; t < before.tets.size(); ++t) {
    before.materials[t] = random.below(20) == 0 ? 5 : 1;
    before.cell_fields[0].values.push_back(static_cast<double>(t));
  }
  TetMesh after = cube(3, 17);
  for (Vec3& p : after.points) p += Vec3::Constant(0.4);
  std::fill(after.materials.begin(), after.materials.end(), 5);
  transfer_fields(before, after);
  const auto distance = [&](const Vec3& p, const Tet& t) {
    // Sampling the tets distinguishes the nearest one from those that are clearly farther away.
    double best = 1e9;
    constexpr int n = 12;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        for (int k = 0; i + j + k <= n; ++k)
          best = std::min(best, ((before.points[t[0]] * i + before.points[t[1]] * j +
                                  before.points[t[2]] * k + before.points[t[3]] * (n - i - j - k)) /
                                     n -
                                 p)
                                    .norm());
    return best;
  };
  for (std::size_t t = 0; t < after.tets.size(); ++t) {
    Vec3 c = Vec3::Zero();
    for (const Index p : after.tets[t]) c += after.points[p] / 4;
    const auto taken = static_cast<std::size_t>(after.cell_fields[0].values[t]);
    ASSERT_EQ(before.materials[taken], 5);
    double best = 1e9;
    for (std::size_t u = 0; u < before.tets.size(); ++u)
      if (before.materials[u] == 5) best = std::min(best, distance(c, before.tets[u]));
    ASSERT_LE(distance(c, before.tets[taken]), best + 0.2);
  }
}

TEST(FieldTransfer, NaNReachesWhatDependsOnIt) {
  TetMesh before = two_tets();
  before.point_fields = {{"x", 1, false, {1, 1, 1, nan, 5}}};
  TetMesh after;
  after.points = {{0.2, 0.2, 0.2}, {0, 0, 1}, {0.25, 0.25, 0}, {0.2, 0.2, -0.5}, {1, 1, -1e-3}};
  transfer_fields(before, after);
  const std::vector<double>& x = after.point_fields[0].values;
  EXPECT_TRUE(std::isnan(x[0]));
  EXPECT_TRUE(std::isnan(x[1]));
  EXPECT_EQ(x[2], 1);  // on the opposite face
  EXPECT_NEAR(x[3], 3, 1e-15);
  EXPECT_FALSE(std::isnan(x[4]));
}

TEST(FieldTransfer, SameForAnyThreads) {
  TetMesh before = cube(10, 18);
  Random random(19);
  before.point_fields = {{"noise", 2, false, std::vector<double>(2 * before.points.size())},
                         {"id", 1, true, std::vector<double>(before.points.size())}};
  before.cell_fields = {{"noise", 1, false, std::vector<double>(before.tets.size())}};
  for (MeshField& f : before.point_fields)
    for (double& v : f.values) v = random.below(1000);
  for (double& v : before.cell_fields[0].values) v = random.uniform();
  for (MaterialTag& m : before.materials) m = static_cast<MaterialTag>(random.below(4));
  TetMesh one = grid_mesh(13);
  for (Vec3& p : one.points) p = p * 0.8 - Vec3::Constant(0.2);
  for (MaterialTag& m : one.materials) m = static_cast<MaterialTag>(random.below(5));
  TetMesh four = one;
  {
    const ThreadLimit limit(1);
    transfer_fields(before, one);
  }
  {
    const ThreadLimit limit(4);
    transfer_fields(before, four);
  }
  EXPECT_EQ(one.point_fields, four.point_fields);
  EXPECT_EQ(one.cell_fields, four.cell_fields);
}

TEST(FieldTransfer, FarFromTheOrigin) {
  TetMesh before = cube(4, 20);
  for (Vec3& p : before.points) p += Vec3(1e7, -3e6, 5e5);
  before.point_fields = {sampled(before, [](const Vec3& p) { return p.x() - 1e7; })};
  TetMesh after = random_points(21, 1000, 0.1, 3.9);
  for (Vec3& p : after.points) p += Vec3(1e7, -3e6, 5e5);
  transfer_fields(before, after);
  for (std::size_t p = 0; p < after.points.size(); ++p)
    ASSERT_NEAR(after.point_fields[0].values[p], after.points[p].x() - 1e7, 1e-8);
}

TEST(FieldTransfer, NothingToTakeFrom) {
  TetMesh before;
  before.point_fields = {{"x", 1, false, {}}, {"n", 1, true, {}}};
  before.cell_fields = {{"c", 3, false, {}}};
  TetMesh after = one_tet();
  transfer_fields(before, after);
  for (const double v : after.point_fields[0].values) EXPECT_TRUE(std::isnan(v));
  EXPECT_EQ(after.point_fields[1].values, std::vector<double>(4, 0));
  EXPECT_EQ(after.cell_fields[0].values.size(), 3u);
}

}  // namespace
}  // namespace tetwright::field_transfer_test

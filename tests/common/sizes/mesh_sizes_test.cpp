// SPDX-License-Identifier: Apache-2.0
#include "tetwright/sizes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/random.h"
#include "tests/simplify/meshes.h"

namespace tetwright::mesh_sizes_test {
namespace {

double linear(const Vec3& p) { return 20 + 2 * p.x() - 3 * p.y() + 0.25 * p.z(); }

template <class Mesh>
std::vector<double> lengths_of(const Mesh& mesh) {
  std::vector<double> lengths;
  for (const Vec3& p : mesh.points) lengths.push_back(linear(p));
  return lengths;
}

/// The square from (0, 0) to (1, 1) in the plane z = 0.
TriangleMesh square() { return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}; }

std::vector<std::pair<Vec3, double>> values(const SizeSource& source) {
  std::vector<std::pair<Vec3, double>> all;
  source.for_each_value([&](const Vec3& p, double length) { all.emplace_back(p, length); });
  return all;
}

TEST(MeshSizes, LinearFieldsInACube) {
  const TetMesh mesh = grid_mesh(3);
  const auto source = tet_mesh_sizes(mesh, lengths_of(mesh));
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p(3 * random.uniform(), 3 * random.uniform(), 3 * random.uniform());
    const auto wanted = source->at(p);
    ASSERT_TRUE(wanted);
    EXPECT_NEAR(wanted->length, linear(p), 1e-12);
    EXPECT_EQ(wanted->distance, 0);
  }
  for (const Vec3& p : mesh.points) EXPECT_NEAR(source->at(p)->length, linear(p), 1e-12);
}

TEST(MeshSizes, NothingOutsideBeyondRounding) {
  const TetMesh mesh = grid_mesh(3);
  const auto source = tet_mesh_sizes(mesh, lengths_of(mesh));
  const double diagonal = 3 * std::sqrt(3.0);
  const auto outside = [&](double share) { return source->at({3 + share * diagonal, 1.5, 0.75}); };
  ASSERT_TRUE(outside(0.9e-6));
  EXPECT_NEAR(outside(0.9e-6)->length, linear({3, 1.5, 0.75}), 1e-12);
  EXPECT_EQ(outside(0.9e-6)->distance, 0);
  EXPECT_FALSE(outside(1.1e-6));
  EXPECT_FALSE(source->at({-5, 1, 1}));
}

TEST(MeshSizes, PointsThatNothingUsesDoNotCount) {
  TetMesh mesh = grid_mesh(1);
  const std::size_t used = mesh.points.size();
  mesh.points.emplace_back(1e9, 0, 0);
  std::vector<double> lengths = lengths_of(mesh);
  lengths.back() = std::nan("");
  const auto source = tet_mesh_sizes(mesh, lengths);
  EXPECT_EQ(values(*source).size(), used);
  EXPECT_FALSE(source->at({1.1, 0.5, 0.5}));  // within reach only if the far point counted

  TriangleMesh surface = square();
  surface.points.insert(surface.points.begin(), {5, 5, 5});
  for (Triangle& t : surface.triangles)
    for (Index& p : t) ++p;
  const auto all = values(*surface_sizes(surface, lengths_of(surface)));
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[2].first, Vec3(1, 1, 0));
  EXPECT_EQ(all[2].second, linear({1, 1, 0}));
}

TEST(MeshSizes, SurfacesAnswerEverywhereWithTheirDistance) {
  const TriangleMesh surface = square();
  const auto source = surface_sizes(surface, lengths_of(surface));
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p(random.uniform(), random.uniform(), 4 * random.uniform() - 2);
    const auto wanted = source->at(p);
    ASSERT_TRUE(wanted);
    EXPECT_NEAR(wanted->length, linear({p.x(), p.y(), 0}), 1e-12);
    EXPECT_NEAR(wanted->distance, std::abs(p.z()), 1e-12);
  }
  const auto beside = source->at({4, 0.25, 4});
  ASSERT_TRUE(beside);
  EXPECT_NEAR(beside->length, linear({1, 0.25, 0}), 1e-12);
  EXPECT_NEAR(beside->distance, 5, 1e-12);
}

TEST(MeshSizes, FlatTrianglesCountAsSegments) {
  const TriangleMesh surface{{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}};
  const auto wanted = surface_sizes(surface, {1, 3, 2})->at({0.5, 1, 0});
  ASSERT_TRUE(wanted);
  EXPECT_NEAR(wanted->length, 1.5, 1e-12);
  EXPECT_NEAR(wanted->distance, 1, 1e-12);
}

}  // namespace
}  // namespace tetwright::mesh_sizes_test

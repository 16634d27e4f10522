// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/surface_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/random.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/resources.h"

namespace tetwright::surface_tree_test {
namespace {

Vec3 random_vector(Random& random) {
  const double x = random.uniform(), y = random.uniform();
  return 2 * Vec3(x, y, random.uniform()) - Vec3::Ones();
}

/// Points on triangles, near them at all scales, around the surface and far away.
std::vector<Vec3> probes(const TriangleMesh& mesh, std::size_t count) {
  Random random(5);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [a, b, c] = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
    const double u = random.uniform(), v = (1 - u) * random.uniform();
    const Vec3 on =
        mesh.points[a] + u * (mesh.points[b] - mesh.points[a]) + v * (mesh.points[c] - mesh.points[a]);
    const std::array<double, 6> sizes{1e-6, 1e-3, 0.02, 0.2, 2, 100};
    points.push_back(on + sizes[i % sizes.size()] * random_vector(random));
  }
  return points;
}

double max_error(const TriangleMesh& mesh) {
  const SurfaceTree tree(mesh.points, mesh.triangles);
  double largest = 0;
  for (const Vec3& p : probes(mesh, 1200))
    largest =
        std::max(largest, std::fabs(tree.winding_number(p) - winding_number(mesh.points, mesh.triangles, p)));
  return largest;
}

TriangleMesh random_triangles(std::size_t count) {
  Random random(9);
  TriangleMesh mesh;
  for (std::size_t t = 0; t < count; ++t) {
    const Vec3 middle = random_vector(random);
    for (int k = 0; k < 3; ++k) mesh.points.push_back(middle + 0.1 * random_vector(random));
    const auto first = static_cast<Index>(3 * t);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TEST(WindingNumber, OfClosedSurfacesIsWhole) {
  const TriangleMesh sphere = make_sphere(1), torus = make_torus(1, 0.4);
  EXPECT_NEAR(winding_number(sphere.points, sphere.triangles, {0.9, 0, 0.1}), 1, 1e-12);
  EXPECT_NEAR(winding_number(sphere.points, sphere.triangles, {0.9, 0.9, 0.1}), 0, 1e-12);
  EXPECT_NEAR(winding_number(torus.points, torus.triangles, {0, 0, 0}), 0, 1e-12);
  const TriangleMesh inverted = turned_over(sphere), twice = joined(sphere, make_sphere(2));
  EXPECT_NEAR(winding_number(inverted.points, inverted.triangles, {0.1, 0.2, 0.3}), -1, 1e-12);
  EXPECT_NEAR(winding_number(twice.points, twice.triangles, {0.1, 0.2, 0.3}), 2, 1e-12);
}

TEST(WindingNumber, OnTheSurfaceIsTheMeanOfBothSides) {
  const TriangleMesh box = make_box({0, 0, 0}, {1, 1, 1});
  EXPECT_NEAR(winding_number(box.points, box.triangles, {1, 0.25, 0.5}), 0.5, 1e-12);
  EXPECT_NEAR(SurfaceTree(box.points, box.triangles).winding_number({1, 0.25, 0.5}), 0.5, 1e-12);
}

TEST(WindingNumber, OfOneTriangleAndItsReverseIsItsSolidAngle) {
  const std::vector<Vec3> points{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Triangle> outwards{{0, 1, 2}}, inwards{{0, 2, 1}};
  EXPECT_NEAR(winding_number(points, outwards, Vec3::Zero()), 0.125, 1e-14);
  EXPECT_NEAR(winding_number(points, inwards, Vec3::Zero()), -0.125, 1e-14);
}

TEST(SurfaceTree, WindingNumbersAgreeWithTheExactSum) {
  constexpr double promised = 0.01;
  EXPECT_LT(max_error(make_sphere(1, {5, 6, 7}, 5)), promised);
  EXPECT_LT(max_error(make_torus(1, 0.1, 200, 20)), promised);
  EXPECT_LT(max_error(make_box({0, 0, 0}, {1, 1, 20})), promised);
  EXPECT_LT(max_error(punctured(make_sphere(1, Vec3::Zero(), 5), 20)), promised);
  EXPECT_LT(max_error(joined(make_sphere(1), turned_over(make_sphere(1, {0.3, 0, 0})))), promised);
  EXPECT_LT(max_error(random_triangles(2000)), promised);
}

TEST(SurfaceTree, WorksAtAnyScale) {
  const TriangleMesh sphere = make_sphere(1);
  for (const double scale : {1e-150, 1e150}) {
    TriangleMesh scaled = sphere;
    for (Vec3& p : scaled.points) p *= scale;
    const SurfaceTree tree(scaled.points, scaled.triangles);
    EXPECT_NEAR(tree.winding_number(scale * Vec3(0.1, 0.2, 0.3)), 1, 0.01);
    EXPECT_NEAR(tree.winding_number(scale * Vec3(2, 3, 4)), 0, 0.01);
  }
}

TEST(SurfaceTree, NothingAndFlatTrianglesDoNoHarm) {
  const SurfaceTree none({}, {});
  EXPECT_EQ(none.winding_number({1, 2, 3}), 0);
  const std::vector<Vec3> points(3, Vec3(1, 1, 1));
  const std::vector<Triangle> flat{{0, 1, 2}};
  const SurfaceTree point(points, flat);
  EXPECT_EQ(point.winding_number({1, 1, 1}), 0);
  EXPECT_EQ(point.winding_number({2, 1, 1}), 0);
}

TEST(SurfaceTree, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = make_sphere(1, Vec3::Zero(), 6);  // large enough to be built in parallel
  const std::vector<Vec3> points = probes(mesh, 200);
  const auto values = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    const SurfaceTree tree(mesh.points, mesh.triangles);
    std::vector<double> all;
    for (const Vec3& p : points) all.push_back(tree.winding_number(p));
    return all;
  };
  EXPECT_EQ(values(1), values(4));
}

}  // namespace
}  // namespace tetwright::surface_tree_test

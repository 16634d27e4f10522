// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/distance_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/point_triangle.h"
#include "common/random.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/resources.h"

namespace tetwright::distance_tree_test {
namespace {

constexpr double anywhere = std::numeric_limits<double>::infinity();

Vec3 random_vector(Random& random) {
  const double x = random.uniform(), y = random.uniform();
  return 2 * Vec3(x, y, random.uniform()) - Vec3::Ones();
}

/// A tube of slivers along a diagonal of space, two for each side of its cross-section.
TriangleMesh slivers(int around) {
  const Vec3 axis = Vec3(3, 2, 1).normalized(), first = axis.unitOrthogonal(), second = axis.cross(first);
  TriangleMesh mesh;
  for (int k = 0; k < around; ++k) {
    const double angle = 2 * 3.141592653589793 * k / around;
    for (const double along : {-1.0, 1.0})
      mesh.points.push_back(along * axis + 0.3 * (std::cos(angle) * first + std::sin(angle) * second));
  }
  for (int k = 0; k < around; ++k) {
    const auto a = static_cast<Index>(2 * k), b = static_cast<Index>(2 * ((k + 1) % around));
    mesh.triangles.push_back({a, b, a + 1});
    mesh.triangles.push_back({b, b + 1, a + 1});
  }
  return mesh;
}

/// Points on triangles, near them at all scales and far away.
std::vector<Vec3> probes(const TriangleMesh& mesh, std::size_t count) {
  Random random(5);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [a, b, c] = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
    const double u = random.uniform(), v = (1 - u) * random.uniform();
    const Vec3 on =
        mesh.points[a] + u * (mesh.points[b] - mesh.points[a]) + v * (mesh.points[c] - mesh.points[a]);
    const std::array<double, 6> sizes{0, 1e-6, 1e-3, 0.02, 0.2, 100};
    points.push_back(on + sizes[i % sizes.size()] * random_vector(random));
  }
  return points;
}

double nearest(const TriangleMesh& mesh, const Vec3& p) {
  double squared = anywhere;
  for (const auto& [a, b, c] : mesh.triangles)
    squared = std::min(squared, squared_distance(p, mesh.points[a], mesh.points[b], mesh.points[c]));
  return std::sqrt(squared);
}

TEST(DistanceTree, DistancesAreThoseOfTheNearestTriangle) {
  for (const TriangleMesh& mesh : {make_torus(1, 0.1, 100, 10), slivers(500), make_box({0, 0, 0}, {1, 2, 3}),
                                   joined(slivers(40), make_sphere(0.3))}) {
    const DistanceTree tree(mesh.points, mesh.triangles);
    for (const Vec3& p : probes(mesh, 600)) {
      const double expected = nearest(mesh, p);
      EXPECT_EQ(tree.distance(p, anywhere), expected);
      EXPECT_EQ(tree.distance(p, 0.5 * expected), 0.5 * expected);
    }
  }
}

TEST(DistanceTree, WorksAtAnyScale) {
  const TriangleMesh sphere = make_sphere(1);
  for (const double scale : {1e-150, 1e150}) {
    TriangleMesh scaled = sphere;
    for (Vec3& p : scaled.points) p *= scale;
    const DistanceTree tree(scaled.points, scaled.triangles);
    EXPECT_NEAR(tree.distance(Vec3(3 * scale, 0, 0), 1e200) / scale, 2, 1e-9);
  }
}

TEST(DistanceTree, NothingAndFlatTrianglesDoNoHarm) {
  EXPECT_EQ(DistanceTree({}, {}).distance({1, 2, 3}, 7), 7);
  const std::vector<Vec3> points{{1, 1, 1}, {1, 1, 1}, {5, 1, 1}};
  EXPECT_EQ(DistanceTree(points, std::vector<Triangle>{{0, 0, 1}}).distance({3, 1, 1}, 7), 2);
  EXPECT_EQ(DistanceTree(points, std::vector<Triangle>{{0, 1, 2}}).distance({3, 1, 2}, 7), 1);
}

TEST(DistanceTree, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = joined(make_sphere(1, Vec3::Zero(), 6), slivers(100));
  const auto values = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    const DistanceTree tree(mesh.points, mesh.triangles);
    std::vector<double> all;
    for (const Vec3& p : probes(mesh, 200)) all.push_back(tree.distance(p, 10));
    return all;
  };
  EXPECT_EQ(values(1), values(4));
}

std::vector<std::array<Vec3, 3>> corners_of(const TriangleMesh& mesh) {
  std::vector<std::array<Vec3, 3>> corners;
  for (const auto& [a, b, c] : mesh.triangles)
    corners.push_back({mesh.points[a], mesh.points[b], mesh.points[c]});
  return corners;
}

TEST(ReferenceTree, PartsCoverTheirTriangles) {
  for (const TriangleMesh& mesh : {slivers(200), make_box({0, 0, 0}, {1, 2, 3}), make_sphere(1)}) {
    const std::vector<std::array<Vec3, 3>> corners = corners_of(mesh);
    const std::vector<TriangleReference> parts = split_references(corners);
    Random random(3);
    for (Index t = 0; t < corners.size(); ++t)
      for (int i = 0; i < 50; ++i) {
        const double u = random.uniform(), v = (1 - u) * random.uniform();
        const auto& [a, b, c] = corners[t];
        const Vec3 p = a + u * (b - a) + v * (c - a);
        EXPECT_TRUE(std::any_of(parts.begin(), parts.end(), [&](const TriangleReference& r) {
          return r.triangle == t && r.box.contains(p);
        }));
      }
  }
}

TEST(ReferenceTree, TrianglesOfEqualSizeHaveOnePart) {
  const TriangleMesh sphere = make_sphere(1, Vec3::Zero(), 5);
  EXPECT_EQ(ReferenceTree(corners_of(sphere)).references(), sphere.triangles.size());
}

TEST(ReferenceTree, ASearchAmongSliversVisitsFewOfThem) {
  const TriangleMesh mesh = slivers(300);
  const std::vector<std::array<Vec3, 3>> corners = corners_of(mesh);
  const ReferenceTree tree(corners);
  EXPECT_LE(tree.references(), 4 * corners.size() + 256);
  std::vector<Box3> boxes(corners.size());
  std::vector<Vec3> middles(corners.size(), Vec3::Zero());
  for (std::size_t t = 0; t < corners.size(); ++t)
    for (const Vec3& c : corners[t]) boxes[t].add(c), middles[t] += c / 3;
  const std::vector<Index> order = median_order(boxes, middles, 1);
  const BoxTree whole(boxes.size(), 1, [&](std::size_t i) { return boxes[order[i]]; });
  std::size_t visited = 0, visited_whole = 0;
  for (const Vec3& p : probes(mesh, 500)) {
    const auto distance = [&](std::size_t t, double best) {
      return std::min(best, squared_distance(p, corners[t][0], corners[t][1], corners[t][2]));
    };
    tree.nearest(p, anywhere, [&](std::size_t t, double best) { return ++visited, distance(t, best); });
    whole.nearest(p, anywhere, whole.all(),
                  [&](std::size_t i, double best) { return ++visited_whole, distance(order[i], best); });
  }
  EXPECT_LT(2 * visited, visited_whole);
}

}  // namespace
}  // namespace tetwright::distance_tree_test

// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/self_intersection.h"

#include <gtest/gtest.h>

#include "common/geometry/triangle_intersection.h"
#include "common/parallel/parallel.h"
#include "common/random.h"
#include "common/samples/samples.h"

namespace tetwright::self_intersection_test {
namespace {

TEST(SelfIntersection, SamplesHaveNone) {
  for (const char* name : {"sphere", "torus", "cube", "two_spheres", "knot", "open_sphere"}) {
    const auto mesh = std::get<TriangleMesh>(make_sample(name));
    EXPECT_TRUE(self_intersections(mesh.points, mesh.triangles).empty()) << name;
  }
}

TEST(SelfIntersection, AgreesWithAllPairsForAnyThreads) {
  for (double spread : {1.0, 1e300, 1e-300}) {
    Random random(11);
    std::vector<Vec3> points;
    std::vector<Triangle> triangles;
    for (Index i = 0; i < 300; ++i) {
      const Vec3 centre(random.uniform(), random.uniform(), random.uniform());
      for (int k = 0; k < 3; ++k)
        points.push_back(spread *
                         (centre + 0.2 * Vec3(random.uniform(), random.uniform(), random.uniform())));
      triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
      // Some share vertices.
      if (i % 3 == 1) triangles.back()[0] = 3 * i - 3;
      if (i % 6 == 1) triangles.back()[1] = 3 * i - 2;
    }
    std::vector<std::pair<Index, Index>> expected;
    const auto at = [&](Index t) {
      const Triangle& ids = triangles[t];
      return MeshTriangle{ids, {points[ids[0]], points[ids[1]], points[ids[2]]}};
    };
    for (Index i = 0; i < triangles.size(); ++i)
      for (Index j = i + 1; j < triangles.size(); ++j)
        if (triangles_intersect(at(i), at(j))) expected.emplace_back(i, j);
    EXPECT_GT(expected.size(), 50u);
    for (unsigned threads : {1u, 3u}) {
      const ThreadLimit limit(threads);
      EXPECT_EQ(self_intersections(points, triangles), expected) << spread;
    }
  }
}

TEST(SelfIntersection, FewTriangles) {
  EXPECT_TRUE(self_intersections({}, {}).empty());
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Triangle> twice{{0, 1, 2}, {2, 1, 0}};
  EXPECT_EQ(self_intersections(points, twice), (std::vector<std::pair<Index, Index>>{{0, 1}}));
}

}  // namespace
}  // namespace tetwright::self_intersection_test

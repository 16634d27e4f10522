// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/samples/samples.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {
namespace {

/// A box, oriented outwards.
TriangleMesh box(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.points.push_back(
        {k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(), k & 4 ? high.z() : low.z()});
  for (const auto& [a, b, c, d] : {std::array<Index, 4>{0, 2, 3, 1},
                                   {4, 5, 7, 6},
                                   {0, 1, 5, 4},
                                   {2, 6, 7, 3},
                                   {0, 4, 6, 2},
                                   {1, 3, 7, 5}}) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

void add(TriangleMesh& to, const TriangleMesh& from, bool turned = false) {
  const auto first = static_cast<Index>(to.points.size());
  to.points.insert(to.points.end(), from.points.begin(), from.points.end());
  for (Triangle t : from.triangles) {
    if (turned) std::swap(t[1], t[2]);
    to.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

TEST(SolidShape, CountsPartsAndCavities) {
  TriangleMesh mesh = box(Vec3(0, 0, 0), Vec3(4, 4, 4));
  add(mesh, box(Vec3(1, 1, 1), Vec3(3, 3, 2)), true);
  add(mesh, box(Vec3(10, 0, 0), Vec3(11, 1, 1)));
  const SolidShape shape = solid_shape(mesh.points, mesh.triangles);
  EXPECT_TRUE(shape.manifold);
  EXPECT_EQ(shape.components(), 2u);
  EXPECT_EQ(shape.cavities(), 1u);
  EXPECT_EQ(shape.handles(), 0);
  EXPECT_DOUBLE_EQ(shape.volume(), 64 - 4 + 1);
  EXPECT_NEAR(shape.shells[1].volume, -4, 1e-12);
  EXPECT_EQ(shape.shells[2].place, Vec3(10, 0, 0));
  EXPECT_EQ(shape.shells[2].triangles, 12u);
}

TEST(SolidShape, CountsHandles) {
  TriangleMesh torus;
  constexpr Index n = 12;
  for (Index i = 0; i < n; ++i)
    for (Index k = 0; k < n; ++k) {
      const double u = 2 * M_PI * i / n, v = 2 * M_PI * k / n;
      torus.points.push_back({(3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v)});
    }
  for (Index i = 0; i < n; ++i)
    for (Index k = 0; k < n; ++k) {
      const Index a = i * n + k, b = (i + 1) % n * n + k, c = (i + 1) % n * n + (k + 1) % n,
                  d = i * n + (k + 1) % n;
      torus.triangles.push_back({a, b, c});
      torus.triangles.push_back({a, c, d});
    }
  const TriangleMesh one = torus;
  TriangleMesh other = torus;
  for (Vec3& p : other.points) p.z() += 5;
  add(torus, other);
  const SolidShape shape = solid_shape(torus.points, torus.triangles);
  EXPECT_EQ(shape.handles(), 2);
  EXPECT_EQ(shape.components(), 2u);
  EXPECT_EQ(solid_shape(one.points, one.triangles).handles(), 1);
  EXPECT_NEAR(shape.volume(), 2 * 54, 1e-9);  // volume of the polygons; that of the round bodies is 2 * 59
}

TEST(SolidShape, PartsThatTouchInAPointAreTwo) {
  TriangleMesh mesh = box(Vec3(0, 0, 0), Vec3(1, 1, 1)), other = box(Vec3(1, 1, 1), Vec3(2, 2, 2));
  const auto seven = Vec3(1, 1, 1);
  add(mesh, other);
  for (Triangle& t : mesh.triangles)
    for (Index& i : t)
      if (mesh.points[i] == seven) i = 7;
  const SolidShape shape = solid_shape(mesh.points, mesh.triangles);
  EXPECT_TRUE(shape.manifold);
  EXPECT_TRUE(shape.touches_itself);
  EXPECT_FALSE(solid_shape(other.points, other.triangles).touches_itself);
  EXPECT_EQ(shape.components(), 2u);
  EXPECT_EQ(shape.handles(), 0);
}

TEST(SolidShape, SaysWhereEdgesHaveNotTwoTriangles) {
  TriangleMesh mesh = box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  mesh.triangles.pop_back();
  EXPECT_FALSE(solid_shape(mesh.points, mesh.triangles).manifold);
  mesh = box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  EXPECT_FALSE(solid_shape(mesh.points, mesh.triangles).manifold);
}

}  // namespace
}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "mesher/level_sets/grid_winding.h"

#include <gtest/gtest.h>

#include "tests/mesher/test_surfaces.h"

namespace tetwright::grid_winding_test {
namespace {

constexpr std::array<int, 3> cells{24, 24, 24};

/// Expects the inside where the distance is negative; skips points where the tessellation of the spheres
/// matters.
template <class Distance>
void expect_inside(const TriangleMesh& mesh, Distance&& distance) {
  const GridWinding winding(mesh.points, mesh.triangles, cells);
  for (int x = 0; x <= cells[0]; ++x)
    for (int y = 0; y <= cells[1]; ++y)
      for (int z = 0; z <= cells[2]; ++z) {
        const double d = distance(Vec3(x, y, z));
        if (std::abs(d) > 0.1) {
          ASSERT_EQ(winding.inside(x, y, z), d < 0) << x << ' ' << y << ' ' << z;
        }
      }
}

TEST(GridWinding, Cavity) {
  const Vec3 c(12.1, 11.9, 12.3);
  const auto shell = joined(make_sphere(9.97, c), turned_over(make_sphere(5.03, c)));
  expect_inside(shell, [&](const Vec3& p) { return std::max((p - c).norm() - 9.97, 5.03 - (p - c).norm()); });
}

TEST(GridWinding, OverlapIsInside) {
  const Vec3 a(9.2, 12, 12.1), b(14.3, 12.2, 11.8);
  expect_inside(joined(make_sphere(5.02, a), make_sphere(4.98, b)),
                [&](const Vec3& p) { return std::min((p - a).norm() - 5.02, (p - b).norm() - 4.98); });
}

// Every line through the grid hits edges or vertices or lies in the plane of a face.
TEST(GridWinding, BoxOnGridPoints) {
  const GridWinding winding(make_box({3, 4, 5}, {10, 12, 14}).points,
                            make_box({3, 4, 5}, {10, 12, 14}).triangles, cells);
  std::size_t count = 0;
  for (int x = 0; x <= cells[0]; ++x)
    for (int y = 0; y <= cells[1]; ++y)
      for (int z = 0; z <= cells[2]; ++z) {
        const bool in = winding.inside(x, y, z);
        count += in;
        if (x > 3 && x < 10 && y > 4 && y < 12 && z > 5 && z < 14) {
          EXPECT_TRUE(in);
        }
        if (x < 3 || x > 10 || y < 4 || y > 12 || z < 5 || z > 14) {
          EXPECT_FALSE(in);
        }
      }
  EXPECT_EQ(count, 7u * 8u * 9u);  // exactly one of two opposite faces counts as inside
}

}  // namespace
}  // namespace tetwright::grid_winding_test

// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <gtest/gtest.h>

#include <numbers>

#include "common/random.h"

namespace tetwright::quality_test {
namespace {

const std::array<Vec3, 4> regular{Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)};

std::array<Vec3, 4> positive(std::array<Vec3, 4> t) {
  if (tet_volume(t[0], t[1], t[2], t[3]) < 0) std::swap(t[2], t[3]);
  return t;
}

TEST(Quality, RegularTet) {
  const auto t = positive(regular);
  for (double angle : solid_angles(t)) EXPECT_NEAR(angle, regular_solid_angle, 1e-15);
  for (double angle : dihedral_angles(t))
    EXPECT_NEAR(angle, std::acos(1.0 / 3) * 180 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(tet_volume(t[0], t[1], t[2], t[3]), 8.0 / 3, 1e-15);
}

TEST(Quality, CornerOfTheCube) {
  const std::array<Vec3, 4> t{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  const auto solid = solid_angles(t);
  EXPECT_NEAR(solid[0], std::numbers::pi / 2, 1e-15);  // an eighth of the sphere's 4 pi
  const auto dihedral = dihedral_angles(t);
  for (int e = 0; e < 6; ++e) {
    const bool at_corner = tet_edges[e][0] == 0;
    EXPECT_NEAR(dihedral[e], at_corner ? 90 : std::acos(1 / std::sqrt(3.0)) * 180 / std::numbers::pi, 1e-12);
  }
}

// Girard: the solid angle at a vertex of a tet is the sum of its three dihedral angles minus pi.
TEST(Quality, SolidAnglesFollowFromDihedrals) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    std::array<Vec3, 4> t;
    for (Vec3& p : t) p = Vec3(random.uniform(), random.uniform(), random.uniform());
    t = positive(t);
    const auto solid = solid_angles(t);
    const auto dihedral = dihedral_angles(t);
    double smallest = 10;
    for (int k = 0; k < 4; ++k) {
      double sum = -180;
      for (int e = 0; e < 6; ++e)
        if (tet_edges[e][0] == k || tet_edges[e][1] == k) sum += dihedral[e];
      EXPECT_NEAR(solid[k], sum * std::numbers::pi / 180, 1e-7);
      smallest = std::min(smallest, solid[k]);
    }
    EXPECT_DOUBLE_EQ(min_solid_angle(t[0], t[1], t[2], t[3]), smallest);
  }
}

TEST(Quality, NegativeAndFlatTetsHaveNone) {
  const auto t = positive(regular);
  EXPECT_EQ(min_solid_angle(t[1], t[0], t[2], t[3]), 0);
  EXPECT_EQ(min_solid_angle(t[0], t[1], t[2], (t[0] + t[1]) / 2), 0);
  EXPECT_EQ(TetQuality::for_target(1, 1)(t[1], t[0], t[2], t[3]), 0);
}

TEST(Quality, PaperQualityHasThreeFactors) {
  const auto t = positive(regular);
  const double volume = 8.0 / 3, edge = 2 * std::numbers::sqrt2;
  // Ideal volume and sufficiently short edges: only the angle matters, and it is optimal.
  EXPECT_EQ(TetQuality::for_target(volume, 1)(t[0], t[1], t[2], t[3]), 1);
  // Eight times too small: the factor 1/8 under the cube root.
  EXPECT_NEAR(TetQuality::for_target(8 * volume, 1)(t[0], t[1], t[2], t[3]), 0.5, 1e-15);
  // Edges longer than beta ideal ones.
  const double ideal_edge = std::cbrt(volume / 1000);
  EXPECT_NEAR(TetQuality::for_target(volume, 1000)(t[0], t[1], t[2], t[3]), std::cbrt(5 * ideal_edge / edge),
              1e-14);
}

}  // namespace
}  // namespace tetwright::quality_test

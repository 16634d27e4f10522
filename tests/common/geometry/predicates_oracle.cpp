// SPDX-License-Identifier: Apache-2.0

// Compares the predicates with CGAL's exact kernel, on points that are random, nearly coplanar, or of very
// different scales.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/geometry/predicates.h"
#include "common/random.h"

namespace tetwright::predicates_oracle {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 cgal(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

int oracle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return static_cast<int>(CGAL::orientation(cgal(a), cgal(b), cgal(c), cgal(d)));
}

/// A coordinate that is small, large, or one of a few values; the latter makes flat tets common.
double coordinate(Random& random) {
  switch (random.below(3)) {
    case 0:
      return static_cast<double>(random.below(4));
    case 1:
      return random.uniform();
    default:
      return std::ldexp(random.uniform() - 0.5, static_cast<int>(random.below(60)) - 30);
  }
}

Vec3 point(Random& random) { return {coordinate(random), coordinate(random), coordinate(random)}; }

TEST(PredicatesOracle, Orient3dAgreesWithCgal) {
  Random random(5);
  int flat = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3 a = point(random), b = point(random), c = point(random);
    Vec3 d = point(random);
    if (random.below(2)) d = a + random.uniform() * (b - a) + random.uniform() * (c - a);  // nearly coplanar
    const int expected = oracle(a, b, c, d);
    flat += expected == 0;
    ASSERT_EQ(orient3d(a, b, c, d), expected) << i;
  }
  EXPECT_GT(flat, 200);
}

TEST(PredicatesOracle, Orient2dAgreesWithCgal) {
  Random random(6);
  for (int i = 0; i < 100000; ++i) {
    const Vec3 a = point(random), b = point(random);
    const Vec3 c = random.below(2) ? point(random) : Vec3(a + random.uniform() * (b - a));
    const auto flat = [](const Vec3& p) { return Kernel::Point_2(p.x(), p.z()); };
    ASSERT_EQ(orient2d(a, b, c, 0, 2), static_cast<int>(CGAL::orientation(flat(a), flat(b), flat(c)))) << i;
  }
}

}  // namespace
}  // namespace tetwright::predicates_oracle

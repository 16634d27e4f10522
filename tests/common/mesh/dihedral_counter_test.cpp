// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/dihedral_counter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/random.h"

namespace tetwright::dihedral_counter_test {
namespace {

using Corners = std::array<Vec3, 4>;

/// Compares the counter with all angles, and the sum of two counters with one. Angles that reach the end of a
/// bin but for rounding count as the next one's.
void expect_all_angles(const std::vector<Corners>& tets) {
  double min = std::numeric_limits<double>::infinity(), max = -min;
  DihedralHistogram expected;
  DihedralCounter one, first, second;
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (const double degrees : dihedral_angles(tets[t])) {
      if (std::isnan(degrees)) continue;
      min = std::min(min, degrees);
      max = std::max(max, degrees);
      ++expected.counts[std::min(DihedralHistogram::bins - 1,
                                 static_cast<std::size_t>((degrees + 1e-10) / DihedralHistogram::step))];
    }
    one.add(tets[t]);
    (t % 2 == 0 ? first : second).add(tets[t]);
  }
  first.add(second);
  for (const DihedralCounter* counter : {&one, &first}) {
    EXPECT_EQ(counter->min(), min);
    EXPECT_EQ(counter->max(), max);
    EXPECT_EQ(counter->histogram().counts, expected.counts);
  }
}

Vec3 random_point(Random& random) { return {random.uniform(), random.uniform(), random.uniform()}; }

TEST(DihedralCounter, IsExactForRandomTets) {
  Random random(1);
  std::vector<Corners> tets(20000);
  for (Corners& tet : tets)
    for (Vec3& p : tet) p = random_point(random);
  expect_all_angles(tets);
}

TEST(DihedralCounter, CountsAnglesAtTheEndsOfBinsAlike) {
  // Angles of lattices are multiples of 45 and 60 degrees, up to rounding.
  std::vector<Corners> tets;
  Random random(2);
  const Corners lattice[] = {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 1, 1)},
                             {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}};
  for (int i = 0; i < 2000; ++i)
    for (Corners tet : lattice) {
      const Vec3 shift = random_point(random);
      const double scale = 0.1 + random.uniform();
      for (Vec3& p : tet) p = p * scale + shift;
      tets.push_back(tet);
    }
  expect_all_angles(tets);
  DihedralCounter all;
  for (const Corners& tet : tets) all.add(tet);
  std::size_t at_ends = 0;  // 45, 60 and 90 degrees; the other angles are arc tangents of sqrt(2)
  for (const std::size_t bin : {9, 12, 18}) at_ends += all.histogram().counts[bin];
  EXPECT_EQ(at_ends, 2000 * (6 + 3));
}

TEST(DihedralCounter, IsExactForThinTetsAndExtremeSizes) {
  std::vector<Corners> tets;
  Random random(3);
  for (int i = 0; i < 5000; ++i) {
    Corners tet;
    for (Vec3& p : tet) p = random_point(random);
    const double thin = std::ldexp(1.0, -static_cast<int>(random.below(60)));
    for (Vec3& p : tet) p.z() *= thin;
    tets.push_back(tet);
    const double size = std::ldexp(1.0, static_cast<int>(random.below(600)) - 300);
    for (Vec3& p : tet) p *= size;
    tets.push_back(tet);
  }
  tets.push_back({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(0, 1, 1)});
  tets.push_back({Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)});
  expect_all_angles(tets);
}

TEST(DihedralCounter, HasNoAnglesAtFirst) {
  const DihedralCounter none;
  EXPECT_GT(none.min(), none.max());
}

}  // namespace
}  // namespace tetwright::dihedral_counter_test

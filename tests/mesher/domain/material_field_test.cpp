// SPDX-License-Identifier: Apache-2.0
#include "mesher/domain/material_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "common/random.h"
#include "tests/mesher/fields.h"
#include "tetwright/resources.h"

namespace tetwright::material_field_test {
namespace {

Vec3 random_direction(Random& random) {
  const Vec3 d(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
  return d.normalized();
}

TEST(MaterialField, DistancesAndProjectionInInputUnits) {
  const Vec3 centre(1.5, -2, 0.25);
  const auto field = make_field({make_sphere(2, centre, 6)}, 0.1);
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Vec3 direction = random_direction(random);
    const double distance = 0.2 * (random.uniform() - 0.5);
    const Vec3 p = centre + (2 + distance) * direction;
    EXPECT_NEAR(field->signed_distance(p, 1), distance, 0.003);
    const auto foot = field->project(p, 1, std::nullopt, 1);
    ASSERT_TRUE(foot);
    EXPECT_NEAR((*foot - centre).norm(), 2, 0.003);
    EXPECT_NEAR((*foot - p).norm(), std::abs(distance), 0.01);
  }
  EXPECT_LT(field->signed_distance(centre, 1), 0);
  EXPECT_FALSE(field->project(centre + Vec3(2.2, 0, 0), 1, std::nullopt, 0.1));
  EXPECT_FALSE(field->project(centre + Vec3(2.2, 0, 0), 1, 77, 1));
}

TEST(MaterialField, ConcurrentProjectionsAreThoseOfOneThread) {
  const auto field = make_field({make_sphere(2)}, 0.1);
  std::vector<Vec3> points, feet(4000);
  Random random(5);
  for (std::size_t i = 0; i < feet.size(); ++i)
    points.push_back((2 + 0.2 * (random.uniform() - 0.5)) * random_direction(random));
  parallel_for(0, feet.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) feet[i] = *field->project(points[i], 1, std::nullopt, 1);
  });
  for (std::size_t i = 0; i < feet.size(); ++i)
    ASSERT_EQ(feet[i], *field->project(points[i], 1, std::nullopt, 1));
}

// The nearest region has the smallest distance of all regions, however these are computed.
TEST(MaterialField, TheNearestOfManyRegionsHasTheSmallestDistance) {
  std::vector<TriangleMesh> balls;
  Random random(7);
  for (int i = 0; i < 12; ++i)
    balls.push_back(
        make_sphere(0.5 + 0.5 * random.uniform(), 1.5 * random.uniform() * random_direction(random)));
  const auto field = make_field(balls, 0.1, {0.2});
  const std::unique_ptr<FieldSampler> sampler = field->sampler();
  std::vector<RegionIndex> all(field->regions().size());
  for (std::size_t r = 0; r < all.size(); ++r) all[r] = static_cast<RegionIndex>(r);
  std::vector<float> values(all.size());
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = field->frame().to_grid(2.5 * random.uniform() * random_direction(random));
    const NearestRegion nearest = sampler->nearest(p);
    sampler->values(p, all, values.data());
    EXPECT_EQ(values[nearest.region], *std::min_element(values.begin(), values.end()));
  }
}

// A later body carves an earlier one, and the outside is where no body is; also on a finer lattice.
TEST(MaterialField, LaterMaterialsCarveEarlierOnes) {
  const auto coarse = make_field({make_sphere(1), make_sphere(0.6, {0.7, 0.03, 0.01})}, 0.05);
  for (int refinement : {0, 2}) {
    const auto field = coarse->refined(refinement);
    const std::unique_ptr<FieldSampler> owned = field->sampler();
    FieldSampler& sampler = *owned;
    Random random(5);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = 1.4 * Vec3(2 * random.uniform() - 1, 2 * random.uniform() - 1, 2 * random.uniform() - 1);
      const double first = p.norm() - 1, second = (p - Vec3(0.7, 0.03, 0.01)).norm() - 0.6;
      if (std::min(std::abs(first), std::abs(second)) < 0.01) continue;
      const NearestRegion nearest = sampler.nearest(field->frame().to_grid(p));
      ASSERT_EQ(nearest.region, second < 0 ? 2 : first < 0 ? 1 : 0);
      ASSERT_GT(nearest.margin, 0);
    }
  }
}

TEST(MaterialField, ProjectsOntoJunctionCurves) {
  const Vec3 centre(0.9, 0, 0);
  const auto field = make_field({make_sphere(1, Vec3::Zero(), 6), make_sphere(0.8, centre, 6)}, 0.05);
  const std::unique_ptr<FieldSampler> owned = field->sampler();
  FieldSampler& sampler = *owned;
  RegionSet all;
  for (RegionIndex r = 0; r < 3; ++r) all.insert(r);
  // The circle in which the spheres meet.
  const double x = (1 + 0.81 - 0.64) / 1.8, radius = std::sqrt(1 - x * x);
  int reached = 0;
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    const double a = 6.28 * random.uniform();
    const Vec3 on(x, radius * std::cos(a), radius * std::sin(a));
    Vec3 p = field->frame().to_grid(on + 0.03 * random_direction(random));
    if (!sampler.project(all, p)) continue;
    ++reached;
    const Vec3 q = field->frame().to_input(p);
    EXPECT_NEAR(q.norm(), 1, 0.002);
    EXPECT_NEAR((q - centre).norm(), 0.8, 0.002);
  }
  EXPECT_GT(reached, 95);
}

// Boxes share a face: no sliver of a third region anywhere on it.
TEST(MaterialField, FacesInContactLeaveNoSlivers) {
  const TriangleMesh left = make_box({-1, -0.5, -0.5}, {0.0131, 0.5, 0.5});
  const TriangleMesh right = make_box({0.0131, -0.5, -0.5}, {1, 0.5, 0.5});
  const TriangleMesh both = make_box({-1, -0.5, -0.5}, {1, 0.5, 0.5});
  for (const auto& surfaces : {std::vector{left, right}, std::vector{both, right}}) {
    const auto field = make_field(surfaces, 0.07);
    const std::unique_ptr<FieldSampler> owned = field->sampler();
    FieldSampler& sampler = *owned;
    Random random(11);
    for (int i = 0; i < 3000; ++i) {
      const Vec3 p(0.0131 + 0.1 * (random.uniform() - 0.5), 0.9 * (random.uniform() - 0.5),
                   0.9 * (random.uniform() - 0.5));
      EXPECT_NE(sampler.nearest(field->frame().to_grid(p)).region, 0);
      const Vec3 q(0.1 + 0.8 * random.uniform(), 0.9 * (random.uniform() - 0.5),
                   0.5 + 0.05 * (random.uniform() - 0.5));
      EXPECT_NE(sampler.nearest(field->frame().to_grid(q)).region, 1);
    }
  }
}

TEST(MaterialField, SheetsAndTheirThickness) {
  const auto field = make_field({make_sphere(1, Vec3::Zero(), 6), make_sphere(0.9, Vec3::Zero(), 6)}, 0.05);
  const std::unique_ptr<FieldSampler> sampler = field->sampler();
  ASSERT_TRUE(sampler->sheets());
  SheetSampler& sheets = *sampler->sheets();
  const auto sheet = sheets.thinnest_sheet(field->frame().to_grid({0.57, 0.55, 0.54}), 0.5);
  ASSERT_TRUE(sheet);
  EXPECT_EQ(sheet->region, 1);
  EXPECT_NEAR(sheet->thickness, 2, 0.05);  // lattice units
  EXPECT_FALSE(sheets.thinnest_sheet(field->frame().to_grid({0, 0, 0.5}), 0.5));
}

/// The thinnest sheet next to the edge of a wedge of this angle on a block, below another one or not.
std::optional<FieldSheet> sheet_in_wedge(double degrees, bool covered) {
  const double height = std::tan(degrees * std::numbers::pi / 180);
  TriangleMesh wedge;
  for (const double z : {0.5, 2.5})
    for (const auto& [x, y] : {std::pair{0.5, 0.0}, {1.5, 0.0}, {1.5, height}})
      wedge.points.emplace_back(x, y, z);
  wedge.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  std::vector<TriangleMesh> bodies{make_box({0, -2, 0}, {3, 0, 3})};
  if (covered) bodies.push_back(make_box({0, 0, 0}, {3, 2, 3}));
  bodies.push_back(wedge);
  const auto field = make_field(bodies, 0.1);
  const std::unique_ptr<FieldSampler> sampler = field->sampler();
  return sampler->sheets()->thinnest_sheet(field->frame().to_grid({0.55, 0.025 * height, 1.5}), 0.5);
}

TEST(MaterialField, WedgesHaveSmallCellsWhereTheyAreSharpOrBesideTheOutside) {
  EXPECT_FALSE(sheet_in_wedge(45, true));
  for (const auto& [degrees, covered] : {std::pair{30.0, true}, {45.0, false}}) {
    const auto sheet = sheet_in_wedge(degrees, covered);
    ASSERT_TRUE(sheet) << degrees;
    EXPECT_EQ(sheet->region, covered ? 3 : 2);
    EXPECT_LT(sheet->thickness, 1) << degrees;  // lattice units
  }
}

TEST(MaterialField, TwoNearest) {
  const auto field = make_field({make_sphere(1), make_sphere(0.5)}, 0.05);
  const std::unique_ptr<FieldSampler> owned = field->sampler();
  FieldSampler& sampler = *owned;
  EXPECT_EQ((*sampler.two_nearest(field->frame().to_grid({0.97, 0, 0})))[1], 1);
  EXPECT_EQ((*sampler.two_nearest(field->frame().to_grid({0.47, 0, 0})))[0], 1);
  EXPECT_FALSE(sampler.two_nearest(field->frame().to_grid({0, 0, 0})));
}

}  // namespace
}  // namespace tetwright::material_field_test

// SPDX-License-Identifier: Apache-2.0
#include "tetwright/sizes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "common/random.h"

namespace tetwright::size_field_test {
namespace {

/// A function of the position, defined where it is above 0, with additional single values.
class Source final : public SizeSource {
 public:
  explicit Source(std::function<double(const Vec3&)> f, std::vector<std::pair<Vec3, double>> values = {})
      : f_(std::move(f)), values_(std::move(values)) {}
  std::optional<WantedLength> at(const Vec3& place) const override {
    const double length = f_(place);
    if (!(length > 0)) return {};
    return WantedLength{length, 0};
  }
  void for_each_value(const std::function<void(const Vec3&, double)>& f) const override {
    for (const auto& [place, length] : values_) f(place, length);
  }

 private:
  std::function<double(const Vec3&)> f_;
  std::vector<std::pair<Vec3, double>> values_;
};

const Vec3 low(1, 2, 3), high(3, 3, 4);

Vec3 random_place(Random& random) {
  return low + (high - low).cwiseProduct(Vec3(random.uniform(), random.uniform(), random.uniform()));
}

SizeLimits graded(double grading) {
  SizeLimits limits;
  limits.grading = grading;
  return limits;
}

TEST(SizeField, GivesLinearSizesBack) {
  const auto wanted = [](const Vec3& p) { return 0.1 + 0.05 * p.x() + 0.02 * p.y() - 0.01 * p.z(); };
  const SizeField field(Source(wanted), low, high, graded(0.5));
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = random_place(random);
    EXPECT_NEAR(field.at(p), wanted(p), 1e-6);
  }
}

TEST(SizeField, GrowsNoFasterThanTheGrading) {
  // Small beyond a plane, ten times as large in front of it.
  const SizeField field(Source([](const Vec3& p) { return p.x() > 2 ? 0.05 : 0.5; }), low, high, graded(0.3));
  EXPECT_NEAR(field.at({2.5, 2.5, 3.5}), 0.05, 1e-6);
  EXPECT_LE(field.at({1.2, 2.5, 3.5}), 0.05 + 0.3 * 0.8);
  EXPECT_GE(field.at({1.2, 2.5, 3.5}), 0.05 + 0.3 * 0.8 / 1.15);
  Random random(11);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = random_place(random), q = random_place(random);
    EXPECT_LE(std::abs(field.at(p) - field.at(q)), 0.3 * (p - q).norm() + 1e-6);
  }
}

TEST(SizeField, ValuesBetweenTheNodesCount) {
  const Vec3 spot(2.0001, 2.5003, 3.5007);
  const SizeField field(Source([](const Vec3&) { return 0.5; }, {{spot, 0.01}}), low, high, graded(0.2));
  EXPECT_LT(field.at(spot), 0.02);
  EXPECT_NEAR(field.at(spot + Vec3(0, 0.4, 0)), 0.01 + 0.2 * 0.4, 0.01);
  EXPECT_NEAR(field.at(low), std::min(0.5, 0.01 + 0.2 * (spot - low).norm()), 0.03);
}

TEST(SizeField, KeepsToTheLimits) {
  SizeLimits limits;
  limits.min_edge = 0.2;
  limits.max_edge = 0.3;
  const SizeField field(Source([](const Vec3& p) { return p.x() > 2 ? 0.01 : 5.0; }), low, high, limits);
  EXPECT_NEAR(field.at({2.9, 2.5, 3.5}), 0.2, 1e-6);
  EXPECT_NEAR(field.at({1.1, 2.5, 3.5}), 0.3, 1e-6);
}

TEST(SizeField, KnowsWhatTheSourceDoesNotReach) {
  const Source half([](const Vec3& p) { return p.x() > 2 ? 0.1 : 0.0; });
  const SizeField field(half, low, high, {});
  EXPECT_FALSE(field.first_beyond(half, {{2.5, 2.5, 3.5}}));
  EXPECT_FALSE(field.first_beyond(half, {{1.95, 2.5, 3.5}})) << "less than an edge away";
  const auto beyond = field.first_beyond(half, {{2.5, 2.5, 3.5}, {1.2, 2.5, 3.5}});
  ASSERT_TRUE(beyond);
  EXPECT_EQ(*beyond, Vec3(1.2, 2.5, 3.5));
  const Source nowhere([](const Vec3&) { return 0.0; });
  EXPECT_TRUE(SizeField(nowhere, low, high, {}).first_beyond(nowhere, {{2, 2.5, 3.5}}));
}

TEST(SizeField, FlatBoxesHaveSizes) {
  const auto wanted = [](const Vec3& p) { return 0.1 + 0.1 * p.x(); };
  const SizeField field(Source(wanted), {0, 0, 0}, {1, 1, 0}, {});
  EXPECT_NEAR(field.at({0.3, 0.6, 0}), 0.13, 1e-6);
}

/// A square between planes of nodes, which returns the distance from it.
class Sheet final : public SizeSource {
 public:
  explicit Sheet(double length) : length_(length) {}
  bool fills_space() const override { return false; }
  std::optional<WantedLength> at(const Vec3& place) const override {
    return WantedLength{length_, std::fabs(normal.dot(place - middle))};
  }
  void for_each_value(const std::function<void(const Vec3&, double)>& f) const override {
    f(middle, length_);
  }

  inline static const Vec3 normal = Vec3(1, 2, 3).normalized(), middle{2, 2.5, 3.5};

 private:
  double length_;
};

TEST(SizeField, OnASurfaceItIsWhatTheSurfaceSays) {
  // Far smaller than the node spacing.
  const SizeField field(Sheet(1e-4), low, high, graded(0.5));
  Random random(7);
  for (int i = 0; i < 2000; ++i) {
    Vec3 place = random_place(random);
    place -= Sheet::normal.dot(place - Sheet::middle) * Sheet::normal;
    if ((place.array() < low.array()).any() || (place.array() > high.array()).any()) continue;
    EXPECT_NEAR(field.at(place), 1e-4, 1e-8);
    // The length grows with the distance from the square, starting at the next cell.
    const Vec3 off = place + 0.2 * Sheet::normal;
    if ((off.array() > high.array()).any()) continue;
    EXPECT_LE(field.at(off), 0.1 + 1e-4);
    EXPECT_GE(field.at(off), 0.08);
  }
}

}  // namespace
}  // namespace tetwright::size_field_test

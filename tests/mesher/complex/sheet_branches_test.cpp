// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/sheet_branches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace tetwright::sheet_branches_test {
namespace {

constexpr double edge_length = 10, reach = 3;

Vec3 direction(double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  return {std::cos(a), std::sin(a), 0};
}

/// Sheets that end at the z axis, each a component in a half-plane at an angle; fronts are where angles are
/// larger.
LabelledComplex sheets_at(const std::vector<double>& angles) {
  LabelledComplex complex;
  complex.points = {Vec3::Zero(), Vec3(0, 0, edge_length)};
  for (const double angle : angles) {
    const auto apex = static_cast<Index>(complex.points.size());
    complex.points.emplace_back(5 * direction(angle));
    complex.sheets.push_back({{0, 1, apex}, 1, 0, complex.sheet_components++});
  }
  return complex;
}

/// Components that a point at an angle sees.
std::vector<std::uint32_t> seen(const std::vector<double>& angles, double degrees) {
  const SheetBranches branches(sheets_at(angles), GridFrame{});
  std::vector<NearSheet> near;
  for (std::uint32_t c = 0; c < angles.size(); ++c) {
    const bool in_front = std::sin((degrees - angles[c]) * std::numbers::pi / 180) > 0;
    near.push_back({c, in_front ? 1.0 : -1.0, Vec3::Zero(), 1, Vec3::Zero(), true});
  }
  branches.hide(direction(degrees) + Vec3(0, 0, 4), reach, near);
  std::vector<std::uint32_t> visible;
  for (const NearSheet& n : near)
    if (n.visible) visible.push_back(n.component);
  return visible;
}

using Seen = std::vector<std::uint32_t>;

TEST(SheetBranches, APointSeesTheSheetsOfItsSector) {
  const std::vector<double> cross{0, 80, 180, 260};
  EXPECT_EQ(seen(cross, 40), (Seen{0, 1}));
  EXPECT_EQ(seen(cross, 130), (Seen{1, 2}));
  EXPECT_EQ(seen(cross, 200), (Seen{2, 3}));
  EXPECT_EQ(seen(cross, 300), (Seen{0, 3}));
  // Opposite halves of a wall are in one plane; those of a fan bound a sector of more than 180 degrees.
  const std::vector<double> fan{0, 20, 40};
  EXPECT_EQ(seen(fan, 200), (Seen{0, 2}));
  EXPECT_EQ(seen(fan, 30), (Seen{1, 2}));
}

TEST(SheetBranches, DoNotHideFromAfar) {
  const SheetBranches branches(sheets_at({0, 90, 180, 270}), GridFrame{});
  std::vector<NearSheet> near;
  for (std::uint32_t c = 0; c < 4; ++c) near.push_back({c, 1, Vec3::Zero(), 1, Vec3::Zero(), true});
  branches.hide(Vec3(2 * reach, 1, 4), reach, near);
  for (const NearSheet& n : near) EXPECT_TRUE(n.visible);
}

TEST(SheetBranches, SectorsFaceEachOtherAcrossTheCurve) {
  const std::vector<double> angles{0, 80, 180, 260};
  const SheetBranches branches(sheets_at(angles), GridFrame{});
  // The sides of the sector that begins at a half: in front of it, and behind the next.
  const auto sector = [&](std::uint32_t first) -> SheetBranches::SideOf {
    return [first](std::uint32_t c) -> std::optional<bool> {
      if (c == first) return true;
      if (c == (first + 1) % 4) return false;
      return {};
    };
  };
  const Vec3 near(0.1, 0.1, 4);
  for (std::uint32_t s = 0; s < 4; ++s) {
    EXPECT_TRUE(branches.face_across(near, reach, sector(s), sector((s + 2) % 4)));
    EXPECT_FALSE(branches.face_across(near, reach, sector(s), sector((s + 1) % 4)));
    EXPECT_FALSE(branches.face_across(near, reach, sector(s), sector(s)));
  }
  EXPECT_FALSE(branches.face_across(Vec3(0.1, 0.1, edge_length + 1), reach, sector(0), sector(2)));
}

TEST(SheetBranches, WithoutAreaDoNotCount) {
  LabelledComplex complex = sheets_at({0, 90, 180});
  complex.points.back() = Vec3(0, 0, 3);  // on the edge
  const SheetBranches branches(complex, GridFrame{});
  std::vector<NearSheet> near;
  for (std::uint32_t c = 0; c < 3; ++c) near.push_back({c, 1, Vec3::Zero(), 1, Vec3::Zero(), true});
  branches.hide(Vec3(1, 1, 4), reach, near);
  for (const NearSheet& n : near) EXPECT_TRUE(n.visible);
}

}  // namespace
}  // namespace tetwright::sheet_branches_test

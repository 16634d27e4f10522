// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/contact_zone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/common/features/parts.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/mesher_input.h"

namespace tetwright {
namespace {

/// Two boxes that share a face in the plane x = y.
MesherInput boxes_at_diagonal() {
  const auto turned = [](const Vec3& low, const Vec3& high) {
    TriangleMesh box = make_box(low, high);
    for (Vec3& p : box.points)
      p = Vec3((p.x() - p.y()) * std::sqrt(0.5), (p.x() + p.y()) * std::sqrt(0.5), p.z());
    return box;
  };
  return make_mesher_input({{"left", 1, turned({3, -2, 2}, {8, 0, 8}), "left.off"},
                            {"right", 2, turned({3, 0, 2}, {8, 2, 8}), "right.off"}});
}

GridFrame frame() {
  GridFrame voxels;
  voxels.cells = voxels.box = {10, 10, 10};
  return voxels;
}

TEST(ContactZone, RoundingDoesNotDecideOnAContact) {
  const MesherInput input = boxes_at_diagonal();
  const ContactZone zone(*input.complex, frame());
  for (const double off : {-1e-13, 0.0, 1e-13})
    for (const double along : {3.0, 4.0, 5.0})
      EXPECT_EQ(zone.nearest({along + off, along, 5}).region, 1) << off;
}

TEST(ContactZone, PointsBesideAContactAreOnTheirSide) {
  const MesherInput input = boxes_at_diagonal();
  const ContactZone zone(*input.complex, frame());
  EXPECT_EQ(zone.nearest({4.001, 4, 5}).region, 1);
  EXPECT_EQ(zone.nearest({4, 4.001, 5}).region, 2);
  EXPECT_NEAR(zone.nearest({4.5, 3.5, 5}).distance.value, std::sqrt(0.5), 1e-9);
}

/// Divides the triangles of a surface at the line x = y = 5 by points at these heights, ascending.
void divide_at_line(TriangleMesh& surface, const std::vector<double>& heights) {
  const auto is_on_line = [&](Index p) { return surface.points[p].x() == 5 && surface.points[p].y() == 5; };
  std::vector<Index> added;
  for (const double z : heights) {
    added.push_back(static_cast<Index>(surface.points.size()));
    surface.points.emplace_back(5, 5, z);
  }
  std::vector<Triangle> triangles;
  for (Triangle t : surface.triangles) {
    for (int k = 0; k < 2 && !(is_on_line(t[0]) && is_on_line(t[1])); ++k)
      std::rotate(t.begin(), t.begin() + 1, t.end());
    std::vector<Index> chain{t[0]};
    if (is_on_line(t[0]) && is_on_line(t[1])) chain.insert(chain.end(), added.begin(), added.end());
    if (surface.points[t[0]].z() > surface.points[t[1]].z()) std::reverse(chain.begin() + 1, chain.end());
    chain.push_back(t[1]);
    for (std::size_t i = 1; i < chain.size(); ++i) triangles.push_back({chain[i - 1], chain[i], t[2]});
  }
  surface.triangles = std::move(triangles);
}

/// Two boxes that touch along the line x = y = 5, z from 2 to 8.
/// \param heights of further points on that line
MesherInput boxes_at_line(const std::vector<double>& heights = {}) {
  TriangleMesh left = make_box({2, 2, 2}, {5, 5, 8}), right = make_box({5, 5, 2}, {8, 8, 8});
  for (TriangleMesh* box : {&left, &right}) divide_at_line(*box, heights);
  return make_mesher_input(
      {{"left", 1, std::move(left), "left.off"}, {"right", 2, std::move(right), "right.off"}});
}

/// A prism along the line x = y = 5, z from 3 to 6, that widens towards smaller x.
TriangleMesh prism_at_line() {
  TriangleMesh mesh;
  for (const double z : {3.0, 6.0})
    for (const double y : {0.0, 1.2, -1.2}) mesh.points.emplace_back(y == 0 ? 5 : 2, 5 + y, z);
  mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  return mesh;
}

double deficit_at(const ContactZone& zone, const Vec3& point) {
  const auto narrow = zone.narrow(point, zone.nearest(point));
  return narrow ? narrow->deficit : 0;
}

Vec3 beside_line(double distance, double degrees, double z) {
  const double angle = degrees * std::numbers::pi / 180;
  return {5 + distance * std::cos(angle), 5 - distance * std::sin(angle), z};
}

TEST(ContactZone, TheOutsideGivesWayInACircleAroundALineInWhichBodiesTouch) {
  const MesherInput input = boxes_at_line();
  const ContactZone zone(*input.complex, frame());
  for (const double distance : {0.5, 1.0, 1.3}) {
    const double deficit = deficit_at(zone, beside_line(distance, 45, 5));
    EXPECT_GT(deficit, 0) << distance;
    for (const double degrees : {2.0, 20.0, 70.0, 88.0})
      EXPECT_NEAR(deficit_at(zone, beside_line(distance, degrees, 5)), deficit, 1e-9)
          << distance << " " << degrees;
  }
  EXPECT_EQ(deficit_at(zone, beside_line(2, 45, 5)), 0);
  EXPECT_EQ(deficit_at(zone, beside_line(2, 2, 5)), 0);
}

TEST(ContactZone, TheOutsideDoesNotGiveWayBeyondTheEndOfALine) {
  const MesherInput input = boxes_at_line();
  const ContactZone zone(*input.complex, frame());
  EXPECT_GT(deficit_at(zone, beside_line(0.5, 45, 2.1)), 0);
  for (const double degrees : {-45.0, 10.0, 45.0, 80.0, 135.0}) {
    EXPECT_EQ(deficit_at(zone, beside_line(0.5, degrees, 1.99)), 0) << degrees;
    EXPECT_EQ(deficit_at(zone, beside_line(0.5, degrees, 8.01)), 0) << degrees;
  }
}

TEST(ContactZone, EndsOfALineDoNotDependOnItsDivision) {
  const MesherInput whole = boxes_at_line();
  const MesherInput divided = boxes_at_line({2.1, 2.2, 2.3, 2.4, 2.5, 2.7, 3, 4, 7.9});
  const ContactZone zone(*whole.complex, frame()), other(*divided.complex, frame());
  for (const double z : {2.05, 2.15, 2.25, 2.45, 2.9, 5.0, 7.6, 7.85, 7.95})
    for (const double degrees : {10.0, 45.0})
      EXPECT_NEAR(deficit_at(other, beside_line(0.5, degrees, z)),
                  deficit_at(zone, beside_line(0.5, degrees, z)), 1e-9)
          << z << " " << degrees;
}

TEST(ContactZone, ABodyThatTouchesTheEdgeOfACommonFaceTouchesInALine) {
  // The prism is on the other side of the line, and shorter.
  const MesherInput input = make_mesher_input({{"left", 1, make_box({5, 5, 2}, {8, 8, 8}), "left.off"},
                                               {"right", 2, make_box({5, 2, 2}, {8, 5, 8}), "right.off"},
                                               {"prism", 3, prism_at_line(), "prism.off"}});
  const std::vector<TouchingEdge> edges = touching_edges(*input.complex);
  ASSERT_FALSE(edges.empty());
  for (const TouchingEdge& edge : edges) {
    EXPECT_EQ(edge.regions, (std::vector<RegionIndex>{1, 2, 3}));
    EXPECT_EQ(edge.joined, (std::vector<std::pair<RegionIndex, RegionIndex>>{{1, 2}}));
  }
  const ContactZone zone(*input.complex, frame());
  const auto above = [](double z) { return Vec3(4.9, 5.3, z); };
  EXPECT_GT(deficit_at(zone, above(4)), 0);
  EXPECT_EQ(deficit_at(zone, above(6.01)), 0);
}

TEST(ContactZone, SlopesAreGradientsOfDeficits) {
  const MesherInput input = boxes_at_line();
  const ContactZone zone(*input.complex, frame());
  constexpr double step = 1e-5;
  for (const double z : {5.0, 2.2}) {
    const Vec3 at = beside_line(0.7, 30, z);
    const auto narrow = zone.narrow(at, zone.nearest(at));
    ASSERT_TRUE(narrow) << z;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 by = step * Vec3::Unit(axis);
      EXPECT_NEAR((deficit_at(zone, at + by) - deficit_at(zone, at - by)) / (2 * step), narrow->slope[axis],
                  1e-6)
          << z << " " << axis;
    }
  }
}

}  // namespace
}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesher_input.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "tests/mesher/prepared.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright::surface_repair_test {
namespace {

constexpr double sphere_volume = 4 * std::numbers::pi / 3;

std::string refusal(const TriangleMesh& mesh) {
  try {
    repair_surface(mesh, "scan.ply");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(SurfaceRepair, NothingIsFoundInACleanClosedSurface) {
  for (const TriangleMesh& mesh : {make_sphere(1), make_torus(1, 0.4), make_box({0, 0, 0}, {1, 2, 3})}) {
    const SurfaceRepair input = repair_surface(mesh, "");
    EXPECT_EQ(findings_text(input), "");
    EXPECT_EQ(input.surface.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(input.surface.closed, mesh.triangles.size());
    EXPECT_EQ(input.surface.points.size(), mesh.points.size());
    EXPECT_NEAR(input.surface.volume, enclosed_volume(mesh), 1e-9);
    EXPECT_TRUE(input.nested.empty());
  }
}

TEST(SurfaceRepair, RepeatedTrianglesAreInTheGroupOfTheFirst) {
  const TriangleMesh box = make_box({0, 0, 0}, {1, 2, 3});
  TriangleMesh thrice = box;
  thrice.groups = {{0, "a"}, {0, "b"}, {0, "c"}};
  thrice.triangle_groups.assign(box.triangles.size(), 2);
  for (const std::uint32_t group : {0, 1})
    for (const auto& [p, q, r] : box.triangles) {
      thrice.triangles.push_back(group == 0 ? Triangle{q, r, p} : Triangle{p, r, q});
      thrice.triangle_groups.push_back(group);
    }
  const SurfaceRepair input = repair_surface(thrice, "");
  EXPECT_EQ(input.surface.groups, std::vector<std::uint32_t>(box.triangles.size(), 2));
  EXPECT_NEAR(input.surface.volume, 6, 1e-12);
}

TEST(SurfaceRepair, MergesASoupAndDropsWhatIsDegenerate) {
  const TriangleMesh box = make_box({0, 0, 0}, {1, 2, 3});
  TriangleMesh soup;
  for (const Triangle& t : box.triangles) {
    const auto first = static_cast<Index>(soup.points.size());
    for (Index v : t) soup.points.push_back(box.points[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
    soup.triangles.push_back({first, first + 1, first});
    soup.triangles.push_back({first + 1, first + 2, first});  // repeated
  }
  soup.points[0].x() = -0.0;
  soup.points.emplace_back(100, 100, 100);  // unused
  const SurfaceRepair input = repair_surface(soup, "soup");
  const RepairedSurface& s = input.surface;
  EXPECT_EQ(s.points.size(), 8u);
  EXPECT_EQ(s.triangles.size(), 12u);
  EXPECT_EQ(s.closed, 12u);
  EXPECT_NEAR(s.volume, 6, 1e-12);
  EXPECT_NEAR(s.area, 22, 1e-12);
  EXPECT_EQ(s.high, Vec3(1, 2, 3));
  EXPECT_EQ(found(input, "points that coincide with an earlier one"), 28u);
  EXPECT_EQ(found(input, "points that no triangle uses"), 1u);
  EXPECT_EQ(found(input, "triangles with equal corners"), 12u);
  EXPECT_EQ(found(input, "repeated triangles"), 12u);
  EXPECT_EQ(input.findings.size(), 4u) << findings_text(input);
}

TEST(SurfaceRepair, FindingsNameTheFirstPlace) {
  TriangleMesh sphere = make_sphere(1);
  sphere.points.emplace_back(7, 8, 9);
  const SurfaceRepair input = repair_surface(sphere, "");
  ASSERT_EQ(input.findings.size(), 1u);
  EXPECT_EQ(input.findings[0].places.at(0), Vec3(7, 8, 9));
  EXPECT_NE(input.findings[0].done, "");
}

// A point in the middle of an edge, used on one side only. The flat triangle closes the gap.
TEST(SurfaceRepair, FlatTrianglesKeepTheirNeighboursTogether) {
  TriangleMesh box = make_box({0, 0, 0}, {1, 1, 1});
  box.points.emplace_back(0, 0.5, 0.5);  // on the edge 0-6 of the triangles 0 4 6 and 0 6 2
  box.triangles[0] = {0, 4, 8};
  box.triangles.push_back({8, 4, 6});
  box.triangles.push_back({0, 8, 6});
  const SurfaceRepair input = repair_surface(box, "");
  EXPECT_EQ(found(input, "triangles with all corners on a line"), 1u);
  EXPECT_EQ(found(input, "boundary edges of holes"), 0u);
  EXPECT_EQ(input.surface.closed, 14u);
  EXPECT_NEAR(input.surface.volume, 1, 1e-12);
}

TEST(SurfaceRepair, RefusesNonsense) {
  EXPECT_NE(refusal({}).find("no triangles"), std::string::npos);
  TriangleMesh box = make_box({0, 0, 0}, {1, 1, 1});
  box.triangles[3][1] = 99;
  EXPECT_NE(refusal(box).find("99 of 8"), std::string::npos);
  box = make_box({0, 0, 0}, {1, 1, 1});
  box.points[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(box).find("finite"), std::string::npos);
  TriangleMesh line;
  line.points = {{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {4, 4, 4}};
  line.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 1, 2}};
  EXPECT_NE(refusal(line).find("flat"), std::string::npos) << refusal(line);
  line.triangles = {{1, 1, 2}};
  EXPECT_NE(refusal(line).find("flat"), std::string::npos) << refusal(line);
}

TEST(SurfaceRepair, AllowsHoles) {
  TriangleMesh sphere = make_sphere(1);
  sphere.triangles.pop_back();
  const SurfaceRepair input = repair_surface(turned_over(sphere), "");
  EXPECT_EQ(found(input, "boundary edges of holes"), 3u);
  EXPECT_EQ(found(input, "components oriented inwards"), 1u);
  EXPECT_EQ(input.surface.closed, 0u);
  EXPECT_GT(winding_at(input.surface, {0, 0, 0}), 0.9);
  EXPECT_NEAR(input.surface.volume, sphere_volume, 0.05);
}

TEST(SurfaceRepair, AllowsASieve) {
  const TriangleMesh sieve = punctured(make_sphere(1, Vec3::Zero(), 5), 20);
  for (const TriangleMesh& mesh : {sieve, turned_over(sieve), partly_turned_over(sieve, 3)}) {
    const SurfaceRepair input = repair_surface(mesh, "");
    EXPECT_EQ(input.surface.triangles.size(), mesh.triangles.size());
    EXPECT_GT(found(input, "boundary edges of holes"), 1000u);
    EXPECT_GT(winding_at(input.surface, {0.3, 0.2, 0.1}), 0.9);
    EXPECT_NEAR(winding_at(input.surface, {1.3, 0.2, 0.1}), 0, 0.1);
  }
}

TEST(SurfaceRepair, ListsSelfIntersections) {
  const SurfaceRepair input = repair_surface(joined(make_sphere(1), make_sphere(1, {1.1, 0.2, 0.1})), "");
  EXPECT_GT(found(input, "pairs of triangles that intersect"), 10u);
  EXPECT_EQ(input.findings.size(), 1u);
}

TEST(SurfaceRepair, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = partly_turned_over(
      joined(punctured(make_sphere(1, Vec3::Zero(), 6), 1000), make_sphere(1.5, Vec3::Zero(), 5)), 3);
  const auto triangles = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return repair_surface(mesh, "").surface.triangles;
  };
  EXPECT_EQ(triangles(1), triangles(4));
}

}  // namespace
}  // namespace tetwright::surface_repair_test

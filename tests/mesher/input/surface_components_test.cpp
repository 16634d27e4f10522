// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/surface_components.h"

#include <gtest/gtest.h>

#include "tests/mesher/prepared.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/error.h"

namespace tetwright::surface_components_test {
namespace {

std::string refusal(const TriangleMesh& mesh) {
  try {
    repair_surface(mesh, "scan.ply");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

/// Drops the triangles whose corners all have this x.
TriangleMesh without_wall(TriangleMesh mesh, double x) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.points[t[0]].x() == x && mesh.points[t[1]].x() == x && mesh.points[t[2]].x() == x;
  });
  return mesh;
}

TEST(SurfaceComponents, OneSidedSurfacesAreRefused) {
  // Six triangles of the projective plane: every edge has two triangles, but the surface is one-sided.
  TriangleMesh plane;
  plane.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}};
  plane.triangles = {{0, 1, 4}, {0, 1, 5}, {0, 2, 3}, {0, 2, 5}, {0, 3, 4},
                     {1, 2, 3}, {1, 2, 4}, {1, 3, 5}, {2, 4, 5}, {3, 4, 5}};
  for (const TriangleMesh& mesh :
       {plane, make_moebius_strip(), make_klein_bottle(), joined(make_sphere(3), make_moebius_strip())}) {
    const std::string why = refusal(mesh);
    EXPECT_NE(why.find("scan.ply: the surface is one-sided"), std::string::npos) << why;
    EXPECT_NE(why.find(" at ("), std::string::npos) << why;
  }
}

TEST(SurfaceComponents, TheMajorityDecides) {
  const TriangleMesh sphere = make_sphere(1);
  const SurfaceRepair input = repair_surface(partly_turned_over(sphere, 3), "");
  EXPECT_EQ(found(input, "triangles oriented against their neighbours"), (sphere.triangles.size() + 2) / 3);
  EXPECT_EQ(input.findings.size(), 1u) << findings_text(input);
  EXPECT_EQ(input.surface.closed, sphere.triangles.size());
  EXPECT_NEAR(winding_at(input.surface, {0.1, 0.2, 0.3}), 1, 1e-9);
}

TEST(SurfaceComponents, ASurfaceListedTwiceStaysOne) {
  const TriangleMesh sphere = make_sphere(1);
  TriangleMesh same = sphere, opposite = sphere;
  same.triangles.insert(same.triangles.end(), sphere.triangles.begin(), sphere.triangles.end());
  const TriangleMesh back = turned_over(sphere);
  opposite.triangles.insert(opposite.triangles.end(), back.triangles.begin(), back.triangles.end());
  for (const TriangleMesh& mesh : {same, opposite, joined(sphere, sphere), joined(sphere, back)}) {
    const SurfaceRepair input = repair_surface(mesh, "");
    EXPECT_EQ(found(input, "repeated triangles"), sphere.triangles.size());
    EXPECT_EQ(input.surface.triangles.size(), sphere.triangles.size());
    EXPECT_EQ(input.surface.closed, sphere.triangles.size());
    EXPECT_NEAR(winding_at(input.surface, {0.1, 0.2, 0.3}), 1, 1e-9);
  }
}

TEST(SurfaceComponents, ASheetListedFromBothSidesStaysOne) {
  TriangleMesh sheet;
  sheet.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
  const SurfaceRepair input = repair_surface(sheet, "");
  EXPECT_EQ(input.surface.triangles.size(), 2u);
  EXPECT_EQ(found(input, "boundary edges of holes"), 4u);
  EXPECT_EQ(found(input, "open components whose outside is unclear"), 1u);
}

// Listing some triangles from both sides must not open a hole.
TEST(SurfaceComponents, APatchListedFromBothSidesStaysClosed) {
  TriangleMesh sphere = make_sphere(1);
  const std::size_t n = sphere.triangles.size();
  for (std::size_t t = 0; t < 40; ++t) {
    const auto [a, b, c] = sphere.triangles[t];
    sphere.triangles.push_back({b, a, c});
  }
  const SurfaceRepair input = repair_surface(sphere, "");
  EXPECT_EQ(input.surface.closed, n);
  EXPECT_EQ(found(input, "repeated triangles"), 40u);
  EXPECT_EQ(found(input, "boundary edges of holes"), 0u);
  EXPECT_NEAR(winding_at(input.surface, {0.1, 0.2, 0.3}), 1, 1e-9);
}

TEST(SurfaceComponents, CubesThatShareAnEdgeOrAVertex) {
  const TriangleMesh cube = make_box({0, 0, 0}, {1, 1, 1});
  for (const TriangleMesh& other : {make_box({1, 1, 0}, {2, 2, 1}), make_box({1, 1, 1}, {2, 2, 2})})
    for (const TriangleMesh& mesh : {joined(cube, other), joined(cube, turned_over(other)),
                                     partly_turned_over(joined(cube, other), 3)}) {
      const SurfaceRepair input = repair_surface(mesh, "");
      EXPECT_EQ(input.surface.closed, 24u) << findings_text(input);
      EXPECT_EQ(found(input, "edges of more than two triangles"), other.points[0].z() == 0 ? 1u : 0u);
      EXPECT_NEAR(input.surface.volume, 2, 1e-12);
      EXPECT_NEAR(winding_at(input.surface, {0.5, 0.4, 0.3}), 1, 1e-9);
      EXPECT_NEAR(winding_at(input.surface, other.points[0] + Vec3(0.5, 0.4, 0.3)), 1, 1e-9);
    }
}

TEST(SurfaceComponents, AWallBetweenTwoCubesIsLeftOut) {
  const TriangleMesh left = make_box({0, 0, 0}, {1, 1, 1}), right = make_box({1, 0, 0}, {2.5, 1, 1});
  // The wall twice, or once from either side.
  for (const TriangleMesh& mesh :
       {joined(left, right), joined(left, without_wall(right, 1)), joined(without_wall(left, 1), right)}) {
    const SurfaceRepair input = repair_surface(mesh, "");
    EXPECT_EQ(found(input, "triangles of inner walls and fins"), 2u) << findings_text(input);
    EXPECT_EQ(input.surface.closed, 20u);
    EXPECT_NEAR(input.surface.volume, 2.5, 1e-12);
    EXPECT_NEAR(winding_at(input.surface, {0.99, 0.4, 0.3}), 1, 1e-9);
  }
}

// Two halves with opposite orientations, and a collar of single triangles around their common rim.
TEST(SurfaceComponents, HalvesThatMeetAtACollarAreClosed) {
  TriangleMesh mesh = make_sphere(1);
  const std::size_t n = mesh.triangles.size();
  const auto lower = [&](const Triangle& t) {
    return mesh.points[t[0]].z() + mesh.points[t[1]].z() + mesh.points[t[2]].z() < 0;
  };
  std::vector<Triangle> collar;
  for (Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      if (lower(t) || mesh.points[a].z() != 0 || mesh.points[b].z() != 0) continue;
      mesh.points.push_back(2 * mesh.points[a]);
      collar.push_back({b, a, static_cast<Index>(mesh.points.size() - 1)});
    }
    if (lower(t)) std::swap(t[0], t[1]);
  }
  ASSERT_EQ(collar.size(), 64u);
  mesh.triangles.insert(mesh.triangles.end(), collar.begin(), collar.end());
  const SurfaceRepair input = repair_surface(mesh, "");
  ASSERT_EQ(input.surface.closed, n);
  EXPECT_EQ(input.surface.triangles.size(), n + collar.size());
  EXPECT_EQ(found(input, "triangles of inner walls and fins"), 0u);
  const std::vector<Triangle> closed(input.surface.triangles.begin(),
                                     input.surface.triangles.begin() + static_cast<std::ptrdiff_t>(n));
  EXPECT_NEAR(winding_number(input.surface.points, closed, {0.1, 0.2, 0.3}), 1, 1e-9);
  EXPECT_NEAR(winding_number(input.surface.points, closed, {0.1, 0.2, -0.3}), 1, 1e-9);
}

TEST(SurfaceComponents, AMembraneAcrossTheHoleOfATorusIsLeftOut) {
  constexpr int around = 48, across = 24;
  TriangleMesh mesh = make_torus(1, 0.4, around, across);
  const std::size_t n = mesh.triangles.size();
  const auto middle = static_cast<Index>(mesh.points.size());
  mesh.points.emplace_back(0, 0, 0);
  const auto inner = [&](int i) { return static_cast<Index>(i % around * across + across / 2); };
  for (int i = 0; i < around; ++i) mesh.triangles.push_back({inner(i), inner(i + 1), middle});
  TriangleMesh with_hole = mesh;
  with_hole.triangles.erase(with_hole.triangles.begin());
  for (const TriangleMesh& m : {mesh, with_hole}) {
    const SurfaceRepair input = repair_surface(m, "");
    EXPECT_EQ(found(input, "triangles of inner walls and fins"), static_cast<std::size_t>(around));
    EXPECT_EQ(input.surface.triangles.size(), m.triangles.size() - static_cast<std::size_t>(around));
    EXPECT_EQ(input.surface.closed, m.triangles.size() == mesh.triangles.size() ? n : 0);
  }
}

TEST(SurfaceComponents, FinsListedFromBothSidesAreLeftOut) {
  TriangleMesh mesh = make_sphere(1);
  const std::size_t n = mesh.triangles.size();
  const auto [a, b, c] = mesh.triangles[5];
  mesh.points.push_back(2 * mesh.points[c]);
  const auto tip = static_cast<Index>(mesh.points.size() - 1);
  mesh.triangles.push_back({a, b, tip});
  mesh.triangles.push_back({b, a, tip});
  const SurfaceRepair input = repair_surface(mesh, "");
  EXPECT_EQ(input.surface.triangles.size(), n);
  EXPECT_EQ(input.surface.closed, n);
  EXPECT_EQ(found(input, "triangles of inner walls and fins"), 1u);
  EXPECT_EQ(found(input, "boundary edges of holes"), 0u);
}

}  // namespace
}  // namespace tetwright::surface_components_test

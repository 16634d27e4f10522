// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>

#include "tests/mesher/checked_labels.h"
#include "tests/mesher/fields.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"
#include "tetwright/resources.h"

namespace tetwright::materials_test {
namespace {

constexpr double pi = std::numbers::pi;
double ball_volume(double r) { return 4 * pi / 3 * r * r * r; }

DenseMesh mesh_of(const MesherInput& input, int resolution, bool keep_outside = false) {
  MesherOptions options;
  options.resolution = resolution;
  options.keep_outside = keep_outside;
  DenseMesh meshed = mesh_surfaces(input, options, nullptr);
  for (const MeshFinding& f : check_mesh(meshed.mesh)) ADD_FAILURE() << mesh_finding_line(f);
  // The mesher examines only points on interfaces and on the box; nothing else may be an interface.
  EXPECT_TRUE(without_patches(meshed.mesh.interfaces) == find_interfaces(meshed.mesh));
  return meshed;
}

double volume_of(const TetMesh& mesh, MaterialTag tag) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.materials[t] != tag) continue;
    const auto& [a, b, c, d] = mesh.tets[t];
    sum += tet_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
  }
  return sum;
}

double percent_bad(const TetMesh& mesh) {
  std::size_t bad = 0;
  for (const auto& [a, b, c, d] : mesh.tets)
    bad += min_solid_angle(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) < 0.1;
  return 100.0 * static_cast<double>(bad) / static_cast<double>(mesh.tets.size());
}

TEST(Materials, NestedSpheres) {
  const auto meshed = mesh_of(make_input({make_sphere(1, Vec3::Zero(), 6), make_sphere(0.7, Vec3::Zero(), 6),
                                          make_sphere(0.4, Vec3::Zero(), 6)}),
                              48);
  const TetMesh& mesh = meshed.mesh;
  EXPECT_NEAR(volume_of(mesh, 1), ball_volume(1) - ball_volume(0.7), 0.005 * ball_volume(1));
  EXPECT_NEAR(volume_of(mesh, 2), ball_volume(0.7) - ball_volume(0.4), 0.005 * ball_volume(0.7));
  EXPECT_NEAR(volume_of(mesh, 3), ball_volume(0.4), 0.01 * ball_volume(0.4));
  expect_line(mesh, "domain: components 1, euler 1, boundary components 1, boundary euler 2");
  expect_line(mesh, "material 1: components 1, euler 2, boundary components 2, boundary euler 4");
  expect_line(mesh, "material 3: components 1, euler 1, boundary components 1, boundary euler 2");
  expect_line(mesh, "interface 1|2: components 1, euler 2");
  expect_line(mesh, "interface 2|3: components 1, euler 2");
  EXPECT_LT(percent_bad(mesh), 1);
  EXPECT_EQ(mesh.material_names.at(2), "m2");
  EXPECT_TRUE(meshed.report.thin_parts.empty());
}

TEST(Materials, LayersHaveTheirThickness) {
  const auto meshed = mesh_of(make_input({make_sphere(1, Vec3::Zero(), 5)}, {0.2, 0.25}), 24);
  const TetMesh& mesh = meshed.mesh;
  EXPECT_NEAR(volume_of(mesh, 2), ball_volume(1) - ball_volume(0.8), 0.015 * ball_volume(1));
  EXPECT_NEAR(volume_of(mesh, 3), ball_volume(0.8) - ball_volume(0.55), 0.015 * ball_volume(0.8));
  EXPECT_NEAR(volume_of(mesh, 1), ball_volume(0.55), 0.03 * ball_volume(0.55));
  expect_line(mesh, "interface 2|outside: components 1, euler 2");
  expect_line(mesh, "interface 2|3: components 1, euler 2");
  expect_line(mesh, "interface 1|3: components 1, euler 2");
  EXPECT_LT(percent_bad(mesh), 1);
  EXPECT_EQ(mesh.material_names.at(2), "l1");
}

TEST(Materials, ThinLayersStayWhole) {
  // Voxels have the size 2 / 8; layers are 1.6, 0.8 and 0.32 voxels thick.
  for (double voxels : {1.6, 0.8, 0.32}) {
    const double thickness = voxels * 2 / 8;
    const auto meshed = mesh_of(make_input({make_sphere(1, {0.003, 0.002, 0.001}, 5)}, {thickness}), 8);
    expect_line(meshed.mesh, "material 2: components 1, euler 2, boundary components 2, boundary euler 4");
    expect_line(meshed.mesh, "interface 1|2: components 1, euler 2");
    EXPECT_NEAR(volume_of(meshed.mesh, 2) / (ball_volume(1) - ball_volume(1 - thickness)), 1, 0.1) << voxels;
    EXPECT_EQ(meshed.report.refinement, voxels > 1.5 ? 0 : voxels > 0.75 ? 1 : 3);
    EXPECT_TRUE(meshed.report.thin_parts.empty() || voxels > 1.5);
  }
}

TEST(Materials, WhatIsTooThinIsNamed) {
  const auto meshed =
      mesh_of(make_input({make_box({0, 0, 0}, {1, 1, 1}), make_box({0.2, 0.2, 0.01}, {0.8, 0.8, 0.8})}), 24);
  ASSERT_FALSE(meshed.report.thin_parts.empty());
  EXPECT_EQ(meshed.report.thin_parts[0].name, "m1");
}

TEST(Materials, FourMeetInAPoint) {
  // Each box carves those before it; the first four meet near the origin, inside a ball.
  const TetMesh mesh =
      mesh_of(make_input({make_sphere(1.5, Vec3::Zero(), 5), make_box({-0.51, -0.52, -0.53}, {0.5, 0.5, 0.5}),
                          make_box({0.01, -0.6, -0.61}, {0.6, 0.62, 0.63}),
                          make_box({-0.7, 0.02, -0.71}, {0.7, 0.71, 0.72}),
                          make_box({-0.8, -0.81, 0.03}, {0.8, 0.82, 0.83})}),
              56)
          .mesh;
  const double b = 0.52 * 0.54 * 0.56;
  EXPECT_NEAR(volume_of(mesh, 2), b, 0.02 * b);
  EXPECT_NEAR(volume_of(mesh, 5), 1.6 * 1.63 * 0.8, 0.02 * 2.1);
  for (const char* pair : {"1|2", "2|3", "2|4", "2|5", "3|4", "3|5", "4|5"})
    expect_line(mesh, std::string("interface ") + pair + ": components 1, euler 1");
  expect_line(mesh, "interface 1|outside: components 1, euler 2");
  // Corners: the point where all four boxes meet; points where 1 meets three of them, at three edges; two
  // more.
  expect_line(mesh, "interfaces touch at points: count 0");
  EXPECT_LT(percent_bad(mesh), 2);
}

// The simplifier fits the mesh to this surface.
TEST(Materials, WhatLaterBodiesReplaceIsNoPartOfTheSurface) {
  const MesherInput input =
      make_mesher_input({{"large", 1, make_box({0, 0, 0}, {1, 1, 1}), "a.off"},
                         {"small", 2, make_box({0.75, 0.25, 0.25}, {1.25, 0.75, 0.75}), "b.off"}});
  const DenseMesh dense = mesh_of(input, 16);
  double area = 0;
  for (const auto& [a, b, c] : dense.surface->triangles) {
    const std::vector<Vec3>& p = dense.surface->points;
    area += (p[b] - p[a]).cross(p[c] - p[a]).norm() / 2;
  }
  EXPECT_NEAR(area, 6 + 6 * 0.25 - 0.25, 1e-9);
}

TEST(Materials, KeepOutsideFillsABox) {
  const auto meshed =
      mesh_of(make_input({make_sphere(1, Vec3::Zero(), 6), make_sphere(0.5, Vec3::Zero(), 6)}), 24, true);
  const TetMesh& mesh = meshed.mesh;
  EXPECT_EQ(mesh.material_names.at(0), "outside");
  Vec3 low = mesh.points[0], high = low;
  for (const Vec3& p : mesh.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  EXPECT_NEAR(volume_of(mesh, 0) + volume_of(mesh, 1) + volume_of(mesh, 2), (high - low).prod(), 1e-9);
  EXPECT_NEAR(volume_of(mesh, 2), ball_volume(0.5), 0.03 * ball_volume(0.5));
  expect_line(mesh, "interface 0|1: components 1, euler 2");
  EXPECT_EQ(interface_groups(mesh.interfaces),
            (std::vector<MaterialPair>{{0, std::nullopt}, {0, 1}, {1, 2}}));
}

TEST(Materials, TheSameBytesForAnyNumberOfThreads) {
  const MesherInput input = make_input({make_sphere(1), make_sphere(0.7, {0.6, 0.1, 0})}, {0.15});
  const auto mesh_with = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return mesh_of(input, 20).mesh;
  };
  const TetMesh one = mesh_with(1), three = mesh_with(3);
  EXPECT_EQ(one.points, three.points);
  EXPECT_EQ(one.tets, three.tets);
  EXPECT_EQ(one.materials, three.materials);
  EXPECT_EQ(one.interfaces, three.interfaces);
}

TEST(Materials, RefusesWhatIsCarvedAwayOrTooDeep) {
  // The outermost surface, listed last, covers all others.
  EXPECT_THROW(mesh_of(make_input({make_sphere(0.5), make_sphere(1)}), 24), InputError);
  // Depending on the radius it contains a few lattice points, one or none: it is meshed or refused, never
  // lost.
  for (double radius : {0.02, 0.04, 0.06, 0.08, 0.1, 0.12}) {
    try {
      const TetMesh mesh =
          mesh_of(make_input({make_sphere(1), make_sphere(radius, {0.31, 0.27, 0.22})}), 16).mesh;
      EXPECT_GT(volume_of(mesh, 2), 0) << radius;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("m2"), std::string::npos);
    }
  }
  EXPECT_THROW(mesh_of(make_input({make_sphere(1)}, {1.2}), 24), InputError);
  EXPECT_THROW(mesh_of(make_input({make_sphere(1)}, {0.5, 0.6}), 24), InputError);
}

}  // namespace
}  // namespace tetwright::materials_test

// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/curve_tubes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"

namespace tetwright {
namespace {

/// A prism over a sector of a polygon of 24 sides.
TriangleMesh sector(int first_side, int sides, double turn) {
  TriangleMesh surface;
  const auto rim = [&](int k, double z) {
    const double angle = turn + k * std::numbers::pi / 12;
    return Vec3(std::cos(angle), std::sin(angle), z);
  };
  surface.points = {{0, 0, 0}, {0, 0, 1}};
  for (int k = 0; k <= sides; ++k)
    for (const double z : {0.0, 1.0}) surface.points.push_back(rim(first_side + k, z));
  const auto at = [](int k, int z) { return static_cast<Index>(2 + 2 * k + z); };
  for (int k = 0; k < sides; ++k) {
    surface.triangles.push_back({0, at(k + 1, 0), at(k, 0)});
    surface.triangles.push_back({1, at(k, 1), at(k + 1, 1)});
    surface.triangles.push_back({at(k, 0), at(k + 1, 0), at(k + 1, 1)});
    surface.triangles.push_back({at(k, 0), at(k + 1, 1), at(k, 1)});
  }
  surface.triangles.push_back({0, at(0, 0), at(0, 1)});
  surface.triangles.push_back({0, at(0, 1), 1});
  surface.triangles.push_back({0, at(sides, 1), at(sides, 0)});
  surface.triangles.push_back({0, 1, at(sides, 1)});
  return surface;
}

DenseMesh mesh_of_sectors(int count, double turn, int resolution) {
  std::vector<MaterialSurface> sectors;
  for (int k = 0; k < count; ++k)
    sectors.push_back(
        {"sector" + std::to_string(k + 1), k + 1, sector(k * 24 / count, 24 / count, turn), "sector.off"});
  MesherOptions options;
  options.resolution = resolution;
  return mesh_surfaces(make_mesher_input(std::move(sectors)), options, nullptr);
}

TEST(CurveTubes, SectorsTouchOnlyThoseBesideThem) {
  for (const int count : {4, 6, 8})
    for (const double turn : {0.0, 0.3}) {
      const DenseMesh dense = mesh_of_sectors(count, turn, 16);
      const TetMesh& mesh = dense.mesh;
      EXPECT_EQ(dense.report.strips.faces, 0u) << count << " " << turn;
      std::set<MaterialPair> pairs, expected;
      for (const InterfaceTriangle& t : mesh.interfaces)
        if (t.other) pairs.insert(t.pair());
      for (int k = 1; k < count; ++k) expected.insert({k, k + 1});
      expected.insert({1, count});
      EXPECT_EQ(pairs, expected) << count << " " << turn;
      const Topology::Solid ball{1, 1, 1, 2};
      const Topology found = topology(mesh);
      EXPECT_EQ(found.domain, ball) << count << " " << turn;
      for (const auto& [tag, solid] : found.materials)
        EXPECT_EQ(solid, ball) << count << " " << turn << " " << tag;
      for (const auto& [pair, surface] : found.interfaces)
        EXPECT_EQ(surface, (Topology::Surface{1, 1})) << count << " " << turn;
    }
}

/// Points on the axis must be joined by edges at which all sectors meet.
TEST(CurveTubes, TheCurveIsAChainOfEdges) {
  const TetMesh mesh = mesh_of_sectors(6, 0.1, 16).mesh;
  std::map<std::array<Index, 2>, std::set<MaterialTag>> around;
  const auto is_on_axis = [&](Index p) { return mesh.points[p].head<2>().norm() < 1e-9; };
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const auto& [i, j] : tet_edges) {
      const Index a = mesh.tets[t][i], b = mesh.tets[t][j];
      if (is_on_axis(a) && is_on_axis(b)) around[ascending_edge(a, b)].insert(mesh.materials[t]);
    }
  double length = 0;
  for (const auto& [edge, materials] : around) {
    EXPECT_EQ(materials.size(), 6u);
    length += (mesh.points[edge[0]] - mesh.points[edge[1]]).norm();
  }
  EXPECT_NEAR(length, 1, 1e-9);
}

}  // namespace
}  // namespace tetwright

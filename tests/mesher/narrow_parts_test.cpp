// SPDX-License-Identifier: Apache-2.0

// Bodies that touch in points and lines: what lies between them is thinner than any cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "tests/common/features/parts.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"

namespace tetwright::narrow_parts_test {
namespace {

const Eigen::AngleAxisd common_turn(0.6, Vec3(1, 2, 3).normalized());

TriangleMesh moved(TriangleMesh mesh, const Vec3& by, const Eigen::AngleAxisd& turn = common_turn) {
  for (Vec3& p : mesh.points) p = turn * (p + by);
  return mesh;
}

TetMesh mesh_of(const std::vector<TriangleMesh>& bodies, int resolution) {
  std::vector<MaterialSurface> surfaces;
  for (const TriangleMesh& body : bodies) {
    const auto tag = static_cast<MaterialTag>(surfaces.size() + 1);
    surfaces.push_back({"body" + std::to_string(tag), tag, body, "body.off"});
  }
  MesherOptions options;
  options.resolution = resolution;
  return mesh_surfaces(make_mesher_input(std::move(surfaces)), options, nullptr).mesh;
}

/// Points minus edges plus triangles of the faces for which `accepts` holds: 1 for a disc, 2 for a sphere.
template <class Accepts>
long euler_number(const TetMesh& mesh, const Accepts& accepts) {
  std::set<Index> points;
  std::set<std::array<Index, 2>> edges;
  long triangles = 0;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    if (!accepts(t)) continue;
    ++triangles;
    for (std::size_t k = 0; k < 3; ++k) {
      points.insert(t.ids[k]);
      edges.insert(ascending_edge(t.ids[k], t.ids[(k + 1) % 3]));
    }
  }
  return static_cast<long>(points.size()) - static_cast<long>(edges.size()) + triangles;
}

TEST(NarrowParts, ABallOnAPlateHasOneDiscOfContact) {
  for (const int resolution : {16, 24, 40}) {
    const TetMesh mesh = mesh_of(
        {moved(unit_cube(), Vec3::Zero()), moved(make_sphere(0.45), Vec3(0.5, 0.45, 1.45))}, resolution);
    EXPECT_EQ(euler_number(mesh, [](const InterfaceTriangle& t) { return t.other.has_value(); }), 1)
        << resolution;
    EXPECT_EQ(euler_number(mesh, [](const InterfaceTriangle& t) { return !t.other; }), 2) << resolution;
  }
}

double volume_of(const TetMesh& mesh, MaterialTag tag) {
  std::vector<Tet> tets;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (mesh.materials[t] == tag) tets.push_back(mesh.tets[t]);
  return volume(mesh.points, tets);
}

TEST(NarrowParts, AClosedGapLeavesTheEarlierBodyAsItIs) {
  for (const double to_edge : {0.5, 0.12})
    for (const int resolution : {16, 24, 32}) {
      const TetMesh mesh = mesh_of(
          {moved(unit_cube(), Vec3::Zero()), moved(make_sphere(0.45), Vec3(0.5, to_edge, 1.45))}, resolution);
      EXPECT_NEAR(volume_of(mesh, 1), 1, 5e-4) << to_edge << " " << resolution;
    }
}

TEST(NarrowParts, BodiesAroundALineTouchOnlyThoseBesideThem) {
  std::vector<TriangleMesh> cubes;
  for (const int k : {0, 1, 2, 3}) cubes.push_back(moved(unit_cube(), Vec3(k & 1, k >> 1, 0)));
  for (const int resolution : {16, 24}) {
    const TetMesh mesh = mesh_of(cubes, resolution);
    std::set<MaterialPair> pairs;
    for (const InterfaceTriangle& t : mesh.interfaces)
      if (t.other) pairs.insert(t.pair());
    EXPECT_EQ(pairs, (std::set<MaterialPair>{{1, 2}, {1, 3}, {2, 4}, {3, 4}})) << resolution;
    std::map<MaterialTag, double> volumes;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const auto& [a, b, c, d] = mesh.tets[t];
      const Vec3& o = mesh.points[a];
      volumes[mesh.materials[t]] +=
          (mesh.points[b] - o).cross(mesh.points[c] - o).dot(mesh.points[d] - o) / 6;
    }
    for (const auto& [tag, volume] : volumes) EXPECT_NEAR(volume, 1, 1e-6) << tag << " at " << resolution;
  }
}

/// The mesh of two cubes that touch in an edge.
TetMesh mesh_of_touching_cubes(const Eigen::AngleAxisd& turn, int resolution) {
  return mesh_of({moved(unit_cube(), Vec3::Zero(), turn), moved(unit_cube(), Vec3(1, 1, 0), turn)},
                 resolution);
}

/// A prism along z with an edge on the axis and the opposite face at x = -1.
TriangleMesh wedge(double half_width, double low, double high) {
  TriangleMesh mesh;
  for (const double z : {low, high})
    for (const double y : {0.0, half_width, -half_width}) mesh.points.emplace_back(y == 0 ? 0 : -1, y, z);
  mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  return mesh;
}

TEST(NarrowParts, ABodyThatTouchesTheEdgeOfACommonFaceIsJoined) {
  for (const auto& [low, high] : {std::pair{0.0, 1.0}, {0.2, 0.7}}) {
    const TetMesh mesh =
        mesh_of({make_box({0, 0, 0}, {1, 1, 1}), make_box({0, -1, 0}, {1, 0, 1}), wedge(0.4, low, high)}, 24);
    EXPECT_TRUE(check_mesh(mesh).empty()) << low;
    for (const MaterialPair& pair : {MaterialPair{1, 2}, {1, 3}, {2, 3}})
      EXPECT_EQ(euler_number(mesh, [&](const InterfaceTriangle& t) { return t.other && t.pair() == pair; }),
                1)
          << pair.first << " " << pair.second.value_or(outside_tag);
    EXPECT_EQ(euler_number(mesh, [](const InterfaceTriangle& t) { return !t.other; }), 2) << low;
  }
}

TEST(NarrowParts, BodiesThatTouchInALineAreJoinedInOnePiece) {
  const auto turned = [](double angle) { return Eigen::AngleAxisd(angle, common_turn.axis()); };
  const Eigen::AngleAxisd other_turn(2, Vec3(1, 5, 1).normalized());
  for (const auto& [turn, resolution] : {std::pair(common_turn, 16),
                                         {common_turn, 23},
                                         {common_turn, 30},
                                         {turned(3.6), 26},
                                         {turned(4.3), 18},
                                         {other_turn, 36}}) {
    const TetMesh mesh = mesh_of_touching_cubes(turn, resolution);
    EXPECT_EQ(euler_number(mesh, [](const InterfaceTriangle& t) { return t.other.has_value(); }), 1)
        << resolution;
    EXPECT_EQ(euler_number(mesh, [](const InterfaceTriangle& t) { return !t.other; }), 2) << resolution;
    for (const MaterialTag tag : {1, 2})
      EXPECT_EQ(euler_number(mesh, [&](const InterfaceTriangle& t) { return !t.other && t.material == tag; }),
                1)
          << resolution << " " << tag;
  }
}

TEST(NarrowParts, BodiesThatTouchInALineAreNotJoinedBeyondItsEnds) {
  for (const int resolution : {16, 23, 30}) {
    double beyond = 0;
    for (const Vec3& p : mesh_of_touching_cubes(common_turn, resolution).points) {
      const double height = (common_turn.inverse() * p).z();
      beyond = std::max({beyond, -height, height - 1});
    }
    // Less than half a cell.
    EXPECT_LT(beyond, 1.0 / resolution) << resolution;
  }
}

/// Points at which other than two edges end that have three or more faces.
std::size_t branch_points(const TetMesh& mesh) {
  std::map<std::array<Index, 2>, int> faces;
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (std::size_t k = 0; k < 3; ++k) ++faces[ascending_edge(t.ids[k], t.ids[(k + 1) % 3])];
  std::map<Index, int> ends;
  for (const auto& [edge, count] : faces)
    if (count > 2)
      for (const Index p : edge) ++ends[p];
  return static_cast<std::size_t>(
      std::count_if(ends.begin(), ends.end(), [](const auto& at) { return at.second != 2; }));
}

TEST(NarrowParts, CurvesBranchWhereEightBodiesMeetAndAtTheirEndsOnly) {
  std::vector<TriangleMesh> cubes;
  for (const int k : {0, 1, 2, 3, 4, 5, 6, 7})
    cubes.push_back(moved(unit_cube(), Vec3(k & 1, k >> 1 & 1, k >> 2)));
  for (const int resolution : {18, 20, 22, 26})
    EXPECT_EQ(branch_points(mesh_of(cubes, resolution)), 7u) << resolution;
}

}  // namespace
}  // namespace tetwright::narrow_parts_test

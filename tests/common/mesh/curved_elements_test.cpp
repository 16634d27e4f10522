// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <gtest/gtest.h>

#include <random>

#include "common/samples/samples.h"
#include "tests/common/small_meshes.h"

namespace tetwright::curved_elements_test {
namespace {

struct Element {
  std::array<Vec3, 4> corners;
  std::array<Vec3, 6> midside;
};

Element element(const TetMesh& mesh, const MidsideNodes& nodes, std::size_t t) {
  Element e;
  for (std::size_t k = 0; k < 4; ++k) e.corners[k] = mesh.points[mesh.tets[t][k]];
  for (std::size_t k = 0; k < 6; ++k) e.midside[k] = nodes.points[nodes.of_tets[t][k]];
  return e;
}

/// Jacobian determinant at a point from the shape functions, divided by that of the straight tet.
double scaled_jacobian(const Element& e, const std::array<double, 4>& l) {
  // Shape functions: corner i: l (2 l - 1); edge ab: 4 la lb.
  std::array<Vec3, 4> by_coordinate;
  for (std::size_t i = 0; i < 4; ++i) {
    by_coordinate[i] = (4 * l[i] - 1) * e.corners[i];
    for (std::size_t k = 0; k < 6; ++k) {
      const auto& [a, b] = tet_midside_edges[k];
      if (a == i) by_coordinate[i] += 4 * l[b] * e.midside[k];
      if (b == i) by_coordinate[i] += 4 * l[a] * e.midside[k];
    }
  }
  const Vec3 u = by_coordinate[1] - by_coordinate[0], v = by_coordinate[2] - by_coordinate[0],
             w = by_coordinate[3] - by_coordinate[0];
  const auto& c = e.corners;
  return u.dot(v.cross(w)) / (c[1] - c[0]).dot((c[2] - c[0]).cross(c[3] - c[0]));
}

std::array<double, 4> random_place(std::mt19937_64& random) {
  std::exponential_distribution<double> size(1);
  std::array<double, 4> l;
  double sum = 0;
  for (double& x : l) sum += x = size(random);
  for (double& x : l) x /= sum;
  return l;
}

TEST(CurvedElements, ABoundOfTheJacobian) {
  const TetMesh mesh = one_tet();
  const MidsideNodes nodes = straight_midside_nodes(mesh);
  const Element straight = element(mesh, nodes, 0);
  EXPECT_NEAR(min_scaled_jacobian(straight.corners, straight.midside), 1, 1e-14);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> move(-0.2, 0.2);
  double nearest = 1e9;
  for (int i = 0; i < 300; ++i) {
    Element e = straight;
    for (Vec3& m : e.midside) m += Vec3(move(random), move(random), move(random));
    const double bound = min_scaled_jacobian(e.corners, e.midside);
    double smallest = 1e9;
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<double, 4> corner{};
      corner[k] = 1;
      smallest = std::min(smallest, scaled_jacobian(e, corner));
    }
    for (int k = 0; k < 300; ++k) smallest = std::min(smallest, scaled_jacobian(e, random_place(random)));
    ASSERT_LE(bound, smallest + 1e-12);
    nearest = std::min(nearest, smallest - bound);
  }
  EXPECT_LT(nearest, 0.01);  // attained at corners
}

TEST(CurvedElements, NodesFollowTheSurface) {
  // The sample sphere of radius 1 in a cube has too few tets: use an exact sphere instead.
  TetMesh mesh = std::get<TetMesh>(make_sample("tet_cube"));
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : mesh.points) middle += p / static_cast<double>(mesh.points.size());
  mesh.interfaces = find_interfaces(mesh);
  // Maps the boundary of the cube onto a slightly enlarged ball around it.
  const auto onto_ball = [&](const Vec3& p) { return Vec3(middle + 1.05 * (p - middle)); };
  SurfaceToFollow ball;
  ball.onto_patch = [&](const Vec3& p, const InterfacePatch&, double) { return std::optional(onto_ball(p)); };
  MidsideNodes nodes = straight_midside_nodes(mesh);
  const MidsideNodes straight = nodes;
  const CurvingReport report = curve_midside_nodes(mesh, ball, nodes);
  EXPECT_EQ(report.edges, report.on_surface + report.part_way + report.straight);
  EXPECT_EQ(report.edges, mesh.interfaces.size() * 3 / 2);
  EXPECT_GT(report.on_surface, report.edges / 2);
  std::size_t moved = 0, onto = 0;
  for (std::size_t i = 0; i < nodes.points.size(); ++i) {
    moved += nodes.points[i] != straight.points[i];
    onto += nodes.points[i] == onto_ball(straight.points[i]);
  }
  EXPECT_EQ(moved, report.on_surface + report.part_way);
  EXPECT_EQ(onto, report.on_surface);
}

TEST(CurvedElements, TetsStayValidWhateverTheSurface) {
  TetMesh mesh = std::get<TetMesh>(make_sample("two_materials"));
  mesh.interfaces = find_interfaces(mesh);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> move(-1, 1);
  SurfaceToFollow wild;
  wild.onto_patch = [&](const Vec3& p, const InterfacePatch&, double max_distance) {
    return std::optional<Vec3>(p + 0.57 * max_distance * Vec3(move(random), move(random), move(random)));
  };
  wild.onto_crease = [&](const Vec3& p, double max_distance) { return wild.onto_patch(p, {}, max_distance); };
  MidsideNodes nodes = straight_midside_nodes(mesh);
  const CurvingReport report = curve_midside_nodes(mesh, wild, nodes);
  EXPECT_GT(report.on_surface, 0u);
  EXPECT_GT(report.part_way, 0u);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Element e = element(mesh, nodes, t);
    EXPECT_GE(min_scaled_jacobian(e.corners, e.midside), 0.1);
  }
}

TEST(CurvedElements, InterfacesOfAMeshAreFollowedByPatch) {
  TetMesh mesh = std::get<TetMesh>(make_sample("two_materials"));
  mesh.interfaces = find_interfaces(mesh);
  const SurfaceToFollow surface = follow_interfaces(mesh);
  const InterfaceTriangle& t = mesh.interfaces.front();
  const Vec3 centre = (mesh.points[t.ids[0]] + mesh.points[t.ids[1]] + mesh.points[t.ids[2]]) / 3;
  const auto onto = surface.onto_patch(centre, {t.pair(), t.patch}, 0.1);
  ASSERT_TRUE(onto);
  EXPECT_LT((*onto - centre).norm(), 1e-12);
  EXPECT_FALSE(surface.onto_patch(centre, {{77, std::nullopt}, 0}, 0.1));
  EXPECT_FALSE(surface.onto_patch(Vec3(100, 0, 0), {t.pair(), t.patch}, 0.1));
}

}  // namespace
}  // namespace tetwright::curved_elements_test

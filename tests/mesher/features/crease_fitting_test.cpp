// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/crease_fitting.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "mesher/features/crease_labels.h"
#include "tests/common/features/parts.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"
#include "tetwright/resources.h"

namespace tetwright::crease_fitting_test {
namespace {

constexpr double exact = 1e-9;

DenseMesh mesh_of(const TriangleMesh& surface, int resolution, FeatureAngle angle = {}) {
  MesherOptions options;
  options.resolution = resolution;
  options.feature_angle = angle;
  return mesh_surfaces(make_mesher_input({{"part", 1, surface, "part.off"}}), options, nullptr);
}

/// The patches at each boundary point.
std::map<Index, std::set<std::uint16_t>> patches_at_points(const TetMesh& mesh) {
  std::map<Index, std::set<std::uint16_t>> patches;
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids) patches[p].insert(t.patch);
  return patches;
}

struct CreaseNumbers {
  std::size_t corners = 0;     ///< points of three patches
  std::size_t odd = 0;         ///< other ends and branch points of creases
  double max_distance = 0;     ///< distance of points of two patches from the creases
  double max_off_corner = 0;   ///< distance of points of three patches from the corners
  double max_off_surface = 0;  ///< distance of all boundary points from their patches
};

CreaseNumbers numbers_of(const DenseMesh& dense) {
  CreaseNumbers n;
  constexpr double far = 10;
  const auto distance = [](const std::optional<Vec3>& on, const Vec3& p) {
    return on ? (*on - p).norm() : far;
  };
  const auto patches = patches_at_points(dense.mesh);
  std::map<Index, int> degrees;
  for (const auto& [ends, unused] : [&] {
         std::map<std::pair<Index, Index>, std::set<std::uint16_t>> edges;
         for (const InterfaceTriangle& t : dense.mesh.interfaces)
           for (int k = 0; k < 3; ++k) {
             const Index p = t.ids[k], q = t.ids[(k + 1) % 3];
             edges[{std::min(p, q), std::max(p, q)}].insert(t.patch);
           }
         std::erase_if(edges, [](const auto& e) { return e.second.size() < 2; });
         return edges;
       }()) {
    ++degrees[ends.first];
    ++degrees[ends.second];
  }
  for (const auto& [p, here] : patches) {
    const Vec3& at = dense.mesh.points[p];
    for (const std::uint16_t patch : here)
      n.max_off_surface =
          std::max(n.max_off_surface, distance(dense.reference->onto_patch(at, 1, {}, patch, far), at));
    if (here.size() == 2)
      n.max_distance = std::max(n.max_distance, distance(dense.reference->onto_crease(at, far), at));
    if (here.size() > 2) {
      ++n.corners;
      n.max_off_corner = std::max(n.max_off_corner, distance(dense.reference->onto_corner(at, far), at));
    } else if (here.size() == 2 && degrees[p] != 2) {
      ++n.odd;
    }
  }
  return n;
}

void expect_promises(const TetMesh& mesh) {
  EXPECT_EQ(broken_promise(mesh.points, mesh.tets), "");
  for (const MeshFinding& f : check_mesh(mesh)) ADD_FAILURE() << mesh_finding_line(f);
}

TEST(CreaseFitting, MakesATurnedCubeExact) {
  for (const int resolution : {9, 24}) {
    const DenseMesh dense = mesh_of(turned(unit_cube()), resolution);
    expect_promises(dense.mesh);
    EXPECT_NEAR(volume(dense.mesh.points, dense.mesh.tets), 1, exact);
    const CreaseNumbers n = numbers_of(dense);
    EXPECT_EQ(n.corners, 8U);
    EXPECT_EQ(n.odd, 0U);
    EXPECT_LT(n.max_distance, exact);
    EXPECT_LT(n.max_off_corner, exact);
    EXPECT_LT(n.max_off_surface, exact);
    ASSERT_EQ(dense.report.features.size(), 1U);
    EXPECT_EQ(dense.report.features[0].found.count, 6U);
    EXPECT_EQ(dense.report.creases.corners.size(), 8U);
  }
}

TEST(CreaseFitting, KeepsConcaveEdges) {
  const DenseMesh dense = mesh_of(turned(l_block()), 40);
  expect_promises(dense.mesh);
  EXPECT_NEAR(volume(dense.mesh.points, dense.mesh.tets), 0.75, 1e-4);
  const CreaseNumbers n = numbers_of(dense);
  EXPECT_EQ(n.corners, 12U);
  EXPECT_EQ(n.odd, 0U);
  EXPECT_LT(n.max_distance, 0.1 * dense.report.cell_size);
  EXPECT_LT(n.max_off_corner, 0.2 * dense.report.cell_size);
}

TEST(CreaseFitting, FollowsCurvedRims) {
  const DenseMesh dense = mesh_of(turned(cylinder(48)), 32);
  expect_promises(dense.mesh);
  const CreaseNumbers n = numbers_of(dense);
  EXPECT_EQ(n.corners, 0U);
  EXPECT_EQ(n.odd, 0U);
  EXPECT_LT(n.max_distance, 0.05 * dense.report.cell_size);
  EXPECT_EQ(dense.report.features[0].found.count, 3U);
}

// The sides are smaller than eight squared cells, but thin bodies get smaller cells.
TEST(CreaseFitting, KeepsTheSidesOfAThinRod) {
  TriangleMesh rod = unit_cube();
  for (Vec3& p : rod.points) p.x() *= 400;
  const DenseMesh dense = mesh_of(turned(rod), 32);
  ASSERT_EQ(dense.report.features.size(), 1u);
  EXPECT_GE(dense.report.features[0].found.count, 4u);  // the ends may be too small for patches
  double volume = 0;
  for (const auto& [a, b, c, d] : dense.mesh.tets)
    volume +=
        tet_volume(dense.mesh.points[a], dense.mesh.points[b], dense.mesh.points[c], dense.mesh.points[d]);
  EXPECT_NEAR(volume, 400, 4);
}

TEST(CreaseFitting, LeavesScansAlone) {
  const TriangleMesh sphere = make_sphere(1);
  const DenseMesh with = mesh_of(sphere, 24), without = mesh_of(sphere, 24, {FeatureAngle::Rule::off, 0});
  EXPECT_EQ(with.report.features[0].found.verdict, SurfacePatches::Verdict::smooth);
  EXPECT_TRUE(with.mesh.points == without.mesh.points && with.mesh.tets == without.mesh.tets);
  for (const InterfaceTriangle& t : with.mesh.interfaces) EXPECT_EQ(t.patch, 0);
  EXPECT_FALSE(with.reference->has_patches());
}

TEST(CreaseFitting, OfBodiesWithinEachOther) {
  MesherOptions options;
  options.resolution = 32;
  const DenseMesh dense = mesh_surfaces(
      make_mesher_input({{"block", 1, turned(unit_cube()), "a.off"},
                         {"core", 2, make_sphere(0.2, turned(unit_cube()).points.back() * 0.5), "b.off"}}),
      options, nullptr);
  expect_promises(dense.mesh);
  std::map<MaterialPair, std::set<std::uint16_t>> patches;
  for (const InterfaceTriangle& t : dense.mesh.interfaces) patches[t.pair()].insert(t.patch);
  EXPECT_EQ(patches.at({1, std::nullopt}).size(), 6U);
  EXPECT_EQ(patches.at({1, 2}).size(), 1U);
}

/// At some resolutions an edge joins points of a crease across a patch and encloses a point of it.
TEST(CreaseFitting, PointsEnclosedBetweenACreaseAndAChordDoNotHoldItBack) {
  TriangleMesh bar = make_box({0.7, -0.6, 0.22}, {1.3, 1.7, 0.78});
  const auto turn = Eigen::AngleAxisd(0.126, Vec3(0.35, -0.47, 0.78).normalized());
  for (Vec3& p : bar.points) p = turn * p;
  MesherOptions options;
  for (const int resolution : {15, 16, 17}) {
    options.resolution = resolution;
    const DenseMesh dense =
        mesh_surfaces(make_mesher_input({{"first", 1, make_box({0, 0, 0}, {2, 1, 1}), "first.off"},
                                         {"bar", 2, bar, "b.off"}}),
                      options, nullptr);
    expect_promises(dense.mesh);
    EXPECT_LT(numbers_of(dense).max_distance, 1e-6) << resolution;
  }
}

TEST(CreaseFitting, GivesTheSameBytesForAnyNumberOfThreads) {
  const TriangleMesh surface = turned(l_block());
  const auto with = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return mesh_of(surface, 24);
  };
  const DenseMesh one = with(1), three = with(3);
  EXPECT_TRUE(one.mesh.points == three.mesh.points && one.mesh.tets == three.mesh.tets);
  EXPECT_TRUE(one.mesh.interfaces == three.mesh.interfaces);
}

TEST(PatchSet, KeepsItsOrderAndItsSize) {
  PatchSet set{5, 1, 3, 1};
  EXPECT_EQ(std::vector<int>(set.begin(), set.end()), (std::vector<int>{1, 3, 5}));
  EXPECT_TRUE(set.meets({3, 9}));
  EXPECT_FALSE(set.meets({2, 9}));
  EXPECT_EQ(set.common({5, 1}).size(), 2U);
  for (std::uint16_t p = 10; p < 30; ++p) set.insert(p);
  EXPECT_EQ(set.size(), PatchSet::capacity);
}

}  // namespace
}  // namespace tetwright::crease_fitting_test

// SPDX-License-Identifier: Apache-2.0

// Coarsening of a part of a mesh, and simplification that refers to the mesh from which it was made.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "common/geometry/projection_tree.h"
#include "tests/simplify/meshes.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"
#include "tetwright/simplify.h"

namespace tetwright::coarsen_test {
namespace {

using Corner = std::array<double, 3>;

constexpr int cells = 14;

Corner corner(const Vec3& p) { return {p[0], p[1], p[2]}; }

/// A dense mesh of two materials, of which the points on one side are frozen.
struct Part {
  TetMesh mesh;
  std::vector<std::uint8_t> frozen;
  std::size_t frozen_faces = 0;
};

/// Its coordinates are far from the origin and not exact in other units.
Part part() {
  Part p;
  p.mesh = grid_mesh({cells, cells, cells},
                     [](int x, int y, int) { return std::optional<MaterialTag>(x + y < cells ? -4 : 7); });
  const std::vector<Vec3> even = p.mesh.points;
  jitter(p.mesh, 3);
  for (std::size_t i = 0; i < even.size(); ++i) {
    p.frozen.push_back(even[i].z() == 0);
    Vec3& at = p.mesh.points[i];
    if (p.frozen[i]) at.z() = 0;
    at = Vec3(1000.1, -3, 0.7) + at / 3;
  }
  p.frozen_faces = static_cast<std::size_t>(2 * cells * cells);
  return p;
}

CoarsenOptions options_of(const Part& p, double target) {
  CoarsenOptions options;
  options.target_tets = target;
  options.frozen = p.frozen;
  return options;
}

/// The faces of the boundary and of interfaces whose points are all among these.
std::set<std::array<Corner, 3>> faces_between(const TetMesh& mesh, const std::set<Corner>& points) {
  std::set<std::array<Corner, 3>> faces;
  for (const InterfaceTriangle& t : find_interfaces(mesh)) {
    std::array<Corner, 3> face;
    for (std::size_t k = 0; k < 3; ++k) face[k] = corner(mesh.points[t.ids[k]]);
    std::sort(face.begin(), face.end());
    if (std::all_of(face.begin(), face.end(), [&](const Corner& c) { return points.count(c) > 0; }))
      faces.insert(face);
  }
  return faces;
}

void expect_volumes(const TetMesh& before, const TetMesh& after, double share) {
  const MeshStatistics was = mesh_statistics(before), is = mesh_statistics(after);
  ASSERT_EQ(is.materials.size(), was.materials.size());
  for (const auto& [tag, material] : was.materials)
    EXPECT_NEAR(is.materials.at(tag).volume, material.volume, share * material.volume) << tag;
}

bool same_bytes(const TetMesh& a, const TetMesh& b) {
  return a.points.size() == b.points.size() && a.tets == b.tets && a.materials == b.materials &&
         a.interfaces == b.interfaces &&
         std::memcmp(a.points.data(), b.points.data(), a.points.size() * sizeof(Vec3)) == 0;
}

TEST(Coarsen, KeepsFrozenPointsTopologyAndVolumes) {
  const Part p = part();
  constexpr double target = 1500;
  SimplifyReport report;
  const TetMesh after = coarsen(p.mesh, options_of(p, target), &report);
  for (const MeshFinding& finding : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(finding);
  for (const std::string& d : topology_differences(topology(p.mesh), topology(after))) ADD_FAILURE() << d;
  EXPECT_EQ(after.interfaces, find_interfaces(after));

  std::set<Corner> points, frozen;
  for (const Vec3& at : after.points) points.insert(corner(at));
  for (std::size_t i = 0; i < p.frozen.size(); ++i)
    if (p.frozen[i]) frozen.insert(corner(p.mesh.points[i]));
  EXPECT_TRUE(std::includes(points.begin(), points.end(), frozen.begin(), frozen.end()));
  const auto faces = faces_between(p.mesh, frozen);
  EXPECT_EQ(faces.size(), p.frozen_faces);
  EXPECT_TRUE(faces_between(after, frozen) == faces);

  const double expected = 4 * target + 2.0 * static_cast<double>(p.frozen_faces);
  EXPECT_NEAR(static_cast<double>(after.tets.size()), expected, 0.02 * expected);
  expect_volumes(p.mesh, after, 0.008);
  EXPECT_FALSE(report.iterations.empty());
  EXPECT_EQ(report.iterations.back().tets_after, after.tets.size());
}

TEST(Coarsen, GivesTheSameBytesForAnyNumberOfThreads) {
  const Part p = part();
  CoarsenOptions options = options_of(p, 200);
  const auto with_threads_of = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return coarsen(p.mesh, options);
  };
  const TetMesh one = with_threads_of(1);
  EXPECT_TRUE(same_bytes(one, with_threads_of(3)));
  options.seed = 2;
  EXPECT_FALSE(same_bytes(one, with_threads_of(3)));
}

TEST(Coarsen, KeepsAllTetsIfTheyAreFewEnough) {
  const Part p = part();
  const TetMesh after = coarsen(p.mesh, options_of(p, static_cast<double>(p.mesh.tets.size())));
  EXPECT_EQ(after.tets.size(), p.mesh.tets.size());
  EXPECT_TRUE(check_mesh(after).empty());
  const TetMesh frozen =
      coarsen(p.mesh, {.target_tets = 1, .frozen = std::vector<std::uint8_t>(p.mesh.points.size(), 1)});
  EXPECT_EQ(frozen.tets.size(), p.mesh.tets.size());
  std::set<Corner> before, after_points;
  for (const Vec3& at : p.mesh.points) before.insert(corner(at));
  for (const Vec3& at : frozen.points) after_points.insert(corner(at));
  EXPECT_TRUE(before == after_points);
}

// A small part of a volume may be worth less than one final tet.
TEST(Coarsen, ATargetMayBeAFraction) {
  const Part p = part();
  const TetMesh after = coarsen(p.mesh, options_of(p, 1e-6));
  for (const MeshFinding& finding : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(finding);
  for (const std::string& d : topology_differences(topology(p.mesh), topology(after))) ADD_FAILURE() << d;
  EXPECT_LT(after.tets.size(), p.mesh.tets.size() / 4);
}

TEST(Coarsen, LeavesFewerTetsIfFewerAreAskedFor) {
  const Part p = part();
  constexpr double target = 1500;
  CoarsenOptions options = options_of(p, target);
  const auto usual = static_cast<double>(coarsen(p.mesh, options).tets.size());
  options.tets_for_final = 2;
  const auto fewer = static_cast<double>(coarsen(p.mesh, options).tets.size());
  // Its bounds stop it before it reaches the number.
  EXPECT_LT(fewer, 0.85 * usual);
  EXPECT_GE(fewer, 2 * target);
}

TEST(Coarsen, WrongOptionsAreRefused) {
  const TetMesh mesh = grid_mesh(2);
  for (const double wrong :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW((void)coarsen(mesh, {.target_tets = 10, .tets_for_final = wrong}), UsageError) << wrong;
  for (const double target : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW((void)coarsen(mesh, {.target_tets = target}), UsageError) << target;
  EXPECT_THROW((void)coarsen(mesh, {.target_tets = 10, .frozen = {1}}), UsageError);
  TetMesh damaged = mesh;
  damaged.materials.clear();
  EXPECT_THROW((void)coarsen(damaged, {.target_tets = 10}), InputError);
}

// -- SimplifyOptions::original --

/// A body with two materials and curved sides.
TetMesh dense_body() {
  TetMesh mesh = grid_mesh({cells, cells, cells},
                           [](int x, int, int) { return std::optional<MaterialTag>(2 * x < cells ? 1 : 2); });
  for (Vec3& p : mesh.points) {
    const Vec3 from_centre = p / (0.5 * cells) - Vec3::Constant(1);
    // Between a cube and a ball.
    p = from_centre * (1 - 0.15 * from_centre.squaredNorm());
  }
  mesh.interfaces = find_interfaces(mesh);
  return mesh;
}

OriginalMesh original_of(const TetMesh& mesh) {
  OriginalMesh original;
  original.surface.points = mesh.points;
  original.surface.interfaces = mesh.interfaces;
  for (const auto& [tag, material] : mesh_statistics(mesh).materials) original.volumes[tag] = material.volume;
  original.tets = mesh.tets.size();
  return original;
}

ProjectionTree tree_of(const TetMesh& mesh) {
  std::vector<ProjectionTree::Item> items;
  for (const InterfaceTriangle& t : mesh.interfaces) items.push_back({t.ids, {}});
  return {mesh.points, items};
}

/// Root mean square of the distances from the mesh's boundary and interfaces to those of the original.
double distance(const TetMesh& mesh, const TetMesh& original) {
  return surface_deviation(tree_of(mesh), tree_of(original), 1e-3).rms;
}

/// Max relative difference of a material's volume.
double volume_error(const TetMesh& mesh, const OriginalMesh& original) {
  double worst = 0;
  for (const auto& [tag, material] : mesh_statistics(mesh).materials)
    worst = std::max(worst, std::fabs(material.volume / original.volumes.at(tag) - 1));
  return worst;
}

TEST(SimplifyWithOriginal, ReturnsToItsSurfaceAndVolumes) {
  const TetMesh dense = dense_body();
  const OriginalMesh original = original_of(dense);
  TetMesh coarse = coarsen(dense, {.target_tets = 300});
  for (Vec3& p : coarse.points) p *= 0.97;  // as if coarsening had lost volume
  SimplifyOptions options;
  options.target_tets = 300;
  const TetMesh without = simplify(coarse, options);
  OriginalMesh consumed = original;
  options.original = &consumed;
  const TetMesh with = simplify(coarse, options);
  for (const MeshFinding& finding : check_mesh(with)) ADD_FAILURE() << mesh_finding_line(finding);
  for (const std::string& d : topology_differences(topology(dense), topology(with))) ADD_FAILURE() << d;
  EXPECT_NEAR(static_cast<double>(with.tets.size()), 300, 3);
  EXPECT_LT(distance(with, dense), 0.5 * distance(without, dense));
  EXPECT_LT(volume_error(with, original), 0.5 * volume_error(without, original));
  EXPECT_LT(volume_error(with, original), 0.01);
}

TEST(SimplifyWithOriginal, GivesTheSameBytesForAnyNumberOfThreads) {
  const TetMesh dense = dense_body();
  const OriginalMesh original = original_of(dense);
  const TetMesh coarse = coarsen(dense, {.target_tets = 200});
  SimplifyOptions options;
  options.target_tets = 200;
  const auto with_threads_of = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    OriginalMesh consumed = original;
    options.original = &consumed;
    return simplify(coarse, options);
  };
  EXPECT_TRUE(same_bytes(with_threads_of(1), with_threads_of(3)));
}

}  // namespace
}  // namespace tetwright::coarsen_test

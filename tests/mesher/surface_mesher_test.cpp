// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesher.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "mesher/domain/material_field.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"

namespace tetwright::surface_mesher_test {
namespace {

DenseMesh mesh_of(const TriangleMesh& surface, const MesherOptions& options = {},
                  Progress* progress = nullptr) {
  return mesh_surfaces(make_mesher_input({{"body", 5, surface, "body.ply"}}), options, progress);
}

MesherOptions resolution(int n) {
  MesherOptions options;
  options.resolution = n;
  return options;
}

/// Meshes a surface, checks every guarantee and returns the topology.
SolidTopology meshed_topology(const TriangleMesh& surface, int n, TetMesh* out = nullptr) {
  TetMesh mesh = mesh_of(surface, resolution(n)).mesh;
  EXPECT_EQ(broken_promise(mesh.points, mesh.tets), "");
  EXPECT_TRUE(without_patches(mesh.interfaces) == find_interfaces(mesh));
  const SolidTopology t = solid_topology(mesh.points, mesh.tets);
  if (out) *out = std::move(mesh);
  return t;
}

TEST(Mesher, Sphere) {
  TetMesh mesh;
  const SolidTopology t = meshed_topology(make_sphere(2, {10, -20, 5}, 5), 32, &mesh);
  EXPECT_EQ(t.components, 1);
  EXPECT_EQ(t.euler, 1);
  EXPECT_EQ(t.boundary_euler, 2);
  EXPECT_NEAR(volume(mesh.points, mesh.tets), 32 * std::numbers::pi / 3, 0.01 * 32);
  ASSERT_EQ(mesh.materials.size(), mesh.tets.size());
  for (MaterialTag tag : mesh.materials) ASSERT_EQ(tag, 5);
  EXPECT_EQ(mesh.material_names.at(5), "body");
  std::size_t below = 0;
  for (const auto& [a, b, c, d] : mesh.tets)
    below += min_solid_angle(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) < 0.1;
  EXPECT_LT(static_cast<double>(below), 0.003 * static_cast<double>(mesh.tets.size()));
  for (const Vec3& p : mesh.points) EXPECT_LT((p - Vec3(10, -20, 5)).norm(), 2 + 2.0 / 32);
}

TEST(Mesher, BoundaryIsWithinACellOfTheSurface) {
  const DenseMesh m = mesh_of(make_sphere(1, Vec3::Zero(), 5), resolution(40));
  EXPECT_DOUBLE_EQ(m.report.cell_size, 2.0 / 40);
  EXPECT_EQ(m.report.resolution, 40);
  EXPECT_GT(m.report.cells, 0u);
  for (const Vec3& p : m.mesh.points) EXPECT_LT(m.field->signed_distance(p, 5), 0.3 * m.report.cell_size);
}

TEST(Mesher, Torus) {
  const SolidTopology t = meshed_topology(make_torus(1, 0.4), 30);
  EXPECT_EQ(t.components, 1);
  EXPECT_EQ(t.euler, 0);
  EXPECT_EQ(t.boundary_euler, 0);
}

TEST(Mesher, CavityStays) {
  TetMesh mesh;
  const SolidTopology t = meshed_topology(joined(make_sphere(1), turned_over(make_sphere(0.5))), 32, &mesh);
  EXPECT_EQ(t.components, 1);
  EXPECT_EQ(t.boundary_components, 2);
  EXPECT_EQ(t.euler, 2);
  EXPECT_NEAR(volume(mesh.points, mesh.tets), 4 * std::numbers::pi / 3 * 7 / 8, 0.05);
}

TEST(Mesher, TwoComponents) {
  EXPECT_EQ(meshed_topology(joined(make_sphere(1), turned_over(make_sphere(1, {2.3, 0, 0}))), 40).components,
            2);
}

TEST(Mesher, SelfIntersectingSurface) {
  const SolidTopology t = meshed_topology(joined(make_sphere(1), make_sphere(0.8, {0.9, 0.1, 0.2})), 32);
  EXPECT_EQ(t.components, 1);
  EXPECT_EQ(t.boundary_euler, 2);
}

// Faces on grid planes, where every distance is 0, and sharp edges.
TEST(Mesher, Box) {
  TetMesh mesh;
  const SolidTopology t = meshed_topology(make_box({0, 0, 0}, {2, 1, 0.5}), 32, &mesh);
  EXPECT_EQ(t.boundary_euler, 2);
  EXPECT_NEAR(volume(mesh.points, mesh.tets), 1, 0.01);
}

TEST(Mesher, ThinPlateOfTwoCells) {
  const SolidTopology t = meshed_topology(make_box({0.01, 0.02, 0.03}, {1.01, 0.93, 0.03 + 2.0 / 32}), 32);
  EXPECT_EQ(t.components, 1);
  EXPECT_EQ(t.boundary_euler, 2);
}

TEST(Mesher, SameBytesForAnyNumberOfThreads) {
  const TriangleMesh surface = make_torus(1, 0.35);
  const auto mesh_with = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return mesh_of(surface, resolution(40)).mesh;
  };
  const TetMesh one = mesh_with(1);
  for (unsigned threads : {2u, 5u}) {
    const TetMesh other = mesh_with(threads);
    EXPECT_EQ(one.points, other.points);
    EXPECT_EQ(one.tets, other.tets);
    EXPECT_EQ(one.interfaces, other.interfaces);
  }
}

TEST(Mesher, AdaptiveTakesFarFewerThanUniform) {
  const TriangleMesh ball = make_sphere(1);
  MesherOptions options = resolution(32);
  const TetMesh adaptive = mesh_of(ball, options).mesh;
  options.uniform = true;
  const TetMesh uniform = mesh_of(ball, options).mesh;
  EXPECT_EQ(broken_promise(uniform.points, uniform.tets), "");
  EXPECT_LT(2 * adaptive.tets.size(), uniform.tets.size());
  EXPECT_NEAR(volume(adaptive.points, adaptive.tets), volume(uniform.points, uniform.tets), 0.01);
}

TEST(Mesher, FarFromTheOrigin) {
  const Vec3 far = Vec3::Constant(2e6);  // a million diameters
  const TetMesh mesh = mesh_of(make_sphere(1, far), resolution(24)).mesh;
  EXPECT_EQ(broken_promise(mesh.points, mesh.tets), "");
  EXPECT_THROW(mesh_of(make_sphere(1, Vec3::Constant(1e11)), resolution(24)), InputError);
}

TEST(Mesher, VoxelSizeIsInInputUnits) {
  MesherOptions options;
  options.voxel_size = 0.25;
  EXPECT_EQ(mesh_of(make_sphere(3), options).report.resolution, 24);
}

TEST(Mesher, RefusesBadOptions) {
  const TriangleMesh ball = make_sphere(1, Vec3::Zero(), 2);
  for (int n : {-1, 0, 3, 4097}) EXPECT_THROW(mesh_of(ball, resolution(n)), UsageError);
  for (double h :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e-4}) {
    MesherOptions options;
    options.voxel_size = h;
    EXPECT_THROW(mesh_of(ball, options), UsageError) << h;
  }
  MesherOptions options;
  options.adaptivity = -1;
  EXPECT_THROW(mesh_of(ball, options), UsageError);
  EXPECT_THROW(make_mesher_input({}), UsageError);
  EXPECT_THROW(make_mesher_input({{"a", 1, ball, ""}, {"a", 2, ball, ""}}), UsageError);
  EXPECT_THROW(make_mesher_input({{"a", 1, ball, ""}, {"b", 1, ball, ""}}), UsageError);
  for (double thickness : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(make_mesher_input({{"a", 1, ball, ""}}, {{"b", 2, thickness}}), UsageError);
}

TEST(Mesher, RefusesWhatCannotBeMeshed) {
  MesherOptions options;
  options.voxel_size = 10;
  EXPECT_THROW(mesh_of(make_sphere(1), options), NothingToMeshError);
  // An open surface that encloses nothing fails for any size of cells: a square, and two at right angles.
  TriangleMesh open;
  open.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}};
  open.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (const char* said : {"body.ply: encloses nothing", "the surface is not closed and encloses nothing"}) {
    try {
      mesh_of(open);
      FAIL() << said;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(said), std::string::npos) << e.what();
    }
    open.triangles.insert(open.triangles.end(), {{0, 4, 5}, {0, 5, 1}});
  }
  // A sheet without thickness: nothing is inside.
  TriangleMesh sheet;
  sheet.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 1}};
  EXPECT_THROW(mesh_of(sheet), Error);
}

TEST(Mesher, RefusesWhatDoesNotFitInMemory) {
  MesherOptions options = resolution(4096);
  options.uniform = true;
  EXPECT_THROW(mesh_of(make_sphere(1), options), OutputError);  // immediately, for lack of memory
}

TEST(Mesher, EstimatesWithinAFactor) {
  for (const TriangleMesh& surface : {make_sphere(1), make_torus(1, 0.3)})
    for (bool uniform : {false, true}) {
      MesherOptions options = resolution(40);
      options.uniform = uniform;
      const auto estimated =
          static_cast<double>(estimate_mesh(make_mesher_input({{"", 1, surface, ""}}), options).tets);
      const auto got = static_cast<double>(mesh_of(surface, options).mesh.tets.size());
      EXPECT_LT(estimated, 2 * got);
      EXPECT_GT(estimated, got / 2);
    }
}

class CancelAtStage : public Progress {
 public:
  explicit CancelAtStage(std::string_view stage) : stage_(stage) {}
  void begin_stage(std::string_view name) override {
    ++stages;
    if (name == stage_) cancel();
  }
  int stages = 0;

 private:
  std::string_view stage_;
};

TEST(Mesher, ReportsStagesAndCanBeCancelledInEach) {
  const TriangleMesh ball = make_sphere(1, Vec3::Zero(), 3);
  CancelAtStage never("");
  mesh_of(ball, resolution(16), &never);
  EXPECT_EQ(never.stages, 5);
  for (const char* stage : {"signed distances", "octree", "lattice", "moving points", "cutting"}) {
    CancelAtStage progress(stage);
    EXPECT_THROW(mesh_of(ball, resolution(16), &progress), Interrupted) << stage;
  }
}

}  // namespace
}  // namespace tetwright::surface_mesher_test

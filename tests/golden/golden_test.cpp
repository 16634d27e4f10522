// SPDX-License-Identifier: Apache-2.0

// Compares dense and simplified meshes by hashes, which are equal with g++ and clang++, with and without
// sanitizers. A hash may change only on purpose; a failure prints the new one. Inputs are built-in samples
// and a scan, the Stanford bunny of Debian's glmark2-data: meshes from Tetwright's own mesher, while other
// tests of the simplifier use Kuhn grids.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <variant>

#include "common/samples/samples.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"
#include "tetwright/resources.h"
#include "tetwright/simplify.h"

namespace tetwright::golden_test {
namespace {

/// FNV-1a of the bits of the points, tets and materials.
std::string hash_of(const TetMesh& mesh) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](std::uint64_t bits) {
    for (int k = 0; k < 8; ++k) hash = (hash ^ (bits >> 8 * k & 0xff)) * 0x100000001b3;
  };
  for (const Vec3& p : mesh.points)
    for (int axis = 0; axis < 3; ++axis) {
      std::uint64_t bits;
      std::memcpy(&bits, &p[axis], sizeof bits);
      add(bits);
    }
  for (const Tet& t : mesh.tets)
    for (const Index p : t) add(p);
  for (const MaterialTag tag : mesh.materials) add(static_cast<std::uint64_t>(tag));
  char text[32];
  std::snprintf(text, sizeof text, "%zu tets %016llx", mesh.tets.size(),
                static_cast<unsigned long long>(hash));
  return text;
}

DenseMesh dense_surface(const TriangleMesh& surface, int resolution) {
  MesherOptions options;
  options.resolution = resolution;
  return mesh_surfaces(make_mesher_input({{"body", 1, surface, "surface"}}), options, nullptr);
}

DenseMesh dense_sample(const std::string& name, int resolution) {
  return dense_surface(std::get<TriangleMesh>(make_sample(name)), resolution);
}

/// A ball of two labels, 14 voxels wide.
DenseMesh dense_labels() {
  LabelVolume volume;
  volume.size = {20, 20, 20};
  for (int z = 0; z < 20; ++z)
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x) {
        const double distance = (Vec3(x, y, z) - Vec3::Constant(9.5)).norm();
        volume.labels.push_back(distance > 7 ? 0 : x + y < 20 ? 1 : 2);
      }
  const LabelInput labels =
      make_label_input(std::make_unique<MemoryLabelSource>(std::move(volume)), "ball", {}, nullptr);
  MesherOptions options;
  options.voxel_size = default_cell_size(labels);
  return mesh_labels(labels, options, nullptr);
}

DenseMesh dense_bunny(int resolution) { return dense_surface(read_surface(TETWRIGHT_BUNNY), resolution); }

TetMesh simplified(const DenseMesh& dense, std::size_t target, Schedule schedule = Schedule::tuned) {
  const ThreadLimit three(3);
  SimplifyOptions options;
  options.target_tets = target;
  options.schedule = schedule;
  options.reference = dense.reference.get();
  options.surface = dense.surface.get();
  return simplify(dense.mesh, options);
}

void expect_kept(const TetMesh& before, const TetMesh& after, std::size_t target) {
  for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
  for (const std::string& d : topology_differences(topology(before), topology(after))) ADD_FAILURE() << d;
  EXPECT_NEAR(static_cast<double>(after.tets.size()), static_cast<double>(target),
              0.01 * static_cast<double>(target));
  EXPECT_EQ(mesh_statistics(after, 0.1).below_count, 0u);
}

TEST(Golden, DenseMeshesOfSurfaces) {
  EXPECT_EQ(hash_of(dense_sample("torus", 20).mesh), "12288 tets 3807811a631b9bf0");
  EXPECT_EQ(hash_of(dense_sample("open_sphere", 20).mesh), "24892 tets 53f36f40392e89e6");
  EXPECT_EQ(hash_of(dense_bunny(24).mesh), "31277 tets 6a491e4779b35b34");
}

TEST(Golden, DenseMeshOfLabels) { EXPECT_EQ(hash_of(dense_labels().mesh), "19560 tets 2018265d336ed7f8"); }

TEST(Golden, SimplifiedScan) {
  const DenseMesh dense = dense_bunny(32);
  const TetMesh tuned = simplified(dense, 3000);
  EXPECT_EQ(hash_of(tuned), "2997 tets 22ce542e808a3fd6");
  expect_kept(dense.mesh, tuned, 3000);
  EXPECT_EQ(hash_of(simplified(dense, 6000, Schedule::paper)), "5970 tets 527933c2a3fa1055");
}

TEST(Golden, SimplifiedAndImprovedLabels) {
  const DenseMesh dense = dense_labels();
  const TetMesh after = simplified(dense, 2500);
  EXPECT_EQ(hash_of(after), "2505 tets 7ad782e7524be371");
  expect_kept(dense.mesh, after, 2500);
  const ThreadLimit three(3);
  ImproveOptions options;
  options.max_iterations = 6;
  EXPECT_EQ(hash_of(improve(after, options)), "2407 tets 7791f0b909ee47b4");
  options.only_below = 0.2;
  EXPECT_EQ(hash_of(improve(after, options)), "2424 tets 86597761c06598ab");
}

}  // namespace
}  // namespace tetwright::golden_test

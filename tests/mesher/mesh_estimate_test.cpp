// SPDX-License-Identifier: Apache-2.0
#include "mesher/mesh_estimate.h"

#include <gtest/gtest.h>

#include <limits>

#include "common/samples/samples.h"
#include "mesher/tuning/estimate_tuning.h"
#include "tests/mesher/fields.h"
#include "tests/mesher/label_volumes.h"
#include "tetwright/error.h"

namespace tetwright::mesh_estimate_test {
namespace {

constexpr double tolerance = 0.25;

TriangleMesh surface(const char* sample) { return std::get<TriangleMesh>(make_sample(sample)); }

/// Compares the estimates from the input and from the lattice with the mesh.
void expect_good_estimates(const DenseMesh& dense, double lattice_tolerance = 0.15) {
  const MesherReport& r = dense.report;
  const auto tets = static_cast<double>(dense.mesh.tets.size());
  EXPECT_NEAR(static_cast<double>(r.estimate.tets), tets, tolerance * tets);
  EXPECT_NEAR(static_cast<double>(r.lattice_estimate.tets), tets, lattice_tolerance * tets);
  // The memory that the model predicts for the actual lattice.
  const double lattice =
      EstimateTuning::Memory::per_surface_lattice_tet * static_cast<double>(r.lattice_tets);
  EXPECT_NEAR(static_cast<double>(r.lattice_estimate.bytes), EstimateTuning::Memory::program + lattice,
              tolerance * (EstimateTuning::Memory::program + lattice));
}

MesherOptions with_resolution(int resolution) {
  MesherOptions options;
  options.resolution = resolution;
  return options;
}

TEST(MeshEstimate, IsWithinAQuarterOnSurfaces) {
  for (const char* sample : {"sphere", "torus", "cube", "two_spheres", "knot"})
    for (const int resolution : {48, 64}) {
      SCOPED_TRACE(std::string(sample) + " at " + std::to_string(resolution));
      expect_good_estimates(
          mesh_surfaces(make_input({surface(sample)}), with_resolution(resolution), nullptr));
    }
}

TEST(MeshEstimate, IsWithinAQuarterOnLayersAndSeveralMaterials) {
  const TriangleMesh ball = make_sphere(10, Vec3::Zero(), 5);
  expect_good_estimates(mesh_surfaces(make_input({ball}, {2.0}), with_resolution(60), nullptr), 0.2);
  const TriangleMesh inner = make_sphere(5, Vec3(1, 0, 0), 5), beside = make_sphere(6, Vec3(9, 0, 0), 5);
  expect_good_estimates(mesh_surfaces(make_input({ball, inner}), with_resolution(60), nullptr), 0.2);
  expect_good_estimates(mesh_surfaces(make_input({ball, beside}), with_resolution(60), nullptr), 0.2);
}

TEST(MeshEstimate, IsWithinAQuarterOnUniformCellsAndWithTheOutside) {
  MesherOptions options = with_resolution(48);
  options.uniform = true;
  const MesherInput torus = make_input({surface("torus")});
  // Most of a torus's box is outside and is not meshed.
  const DenseMesh dense = mesh_surfaces(torus, options, nullptr);
  const auto tets = static_cast<double>(dense.mesh.tets.size());
  EXPECT_NEAR(static_cast<double>(dense.report.estimate.tets), tets, 0.1 * tets);
  EXPECT_NEAR(static_cast<double>(dense.report.lattice_estimate.tets), tets, 0.1 * tets);
  options.keep_outside = true;
  const DenseMesh all = mesh_surfaces(torus, options, nullptr);
  EXPECT_NEAR(static_cast<double>(all.report.estimate.tets), static_cast<double>(all.mesh.tets.size()),
              0.1 * static_cast<double>(all.mesh.tets.size()));
  options.uniform = false;
  const DenseMesh adaptive = mesh_surfaces(torus, options, nullptr);
  EXPECT_NEAR(static_cast<double>(adaptive.report.estimate.tets),
              static_cast<double>(adaptive.mesh.tets.size()),
              tolerance * static_cast<double>(adaptive.mesh.tets.size()));
}

TEST(MeshEstimate, IsWithinAQuarterOnLabels) {
  const LabelInput organs =
      make_label_input(std::make_unique<MemoryLabelSource>(std::get<LabelVolume>(make_sample("organs"))),
                       "organs", {}, nullptr);
  const LabelInput ball = make_labels({40, 40, 40}, [](int x, int y, int z) {
    const int d = (x - 20) * (x - 20) + (y - 20) * (y - 20) + (z - 20) * (z - 20);
    return d < 100 ? 2 : d < 250 ? 1 : 0;
  });
  for (const LabelInput* labels : {&organs, &ball})
    for (const double cells_per_voxel : {1.0, 2.0}) {
      if (labels == &organs && cells_per_voxel > 1) continue;  // takes long
      SCOPED_TRACE(labels->file + " with cells per voxel: " + std::to_string(cells_per_voxel));
      MesherOptions options;
      options.voxel_size = default_cell_size(*labels) / cells_per_voxel;
      expect_good_estimates(mesh_labels(*labels, options, nullptr), 0.25);
    }
}

TEST(MeshEstimate, CellsMuchSmallerThanVoxelsTakeMemoryForTheirInterfacesOnly) {
  const LabelInput labels = make_labels({2, 2, 2}, [](int x, int y, int z) {
    return x == y && y == z ? 1 : x > z ? 2 : 0;
  });
  MesherOptions options;
  options.voxel_size = 1.0 / 24;
  const DenseMesh dense = mesh_labels(labels, options, nullptr);
  EXPECT_EQ(dense.report.refinement, 0);  // small islands already have more than eight cells per voxel
  EXPECT_LT(dense.mesh.tets.size(), 2e6);
}

TEST(MeshEstimate, WhatDoesNotFitIsRefusedBeforeItIsMade) {
  MesherOptions options = with_resolution(48);
  options.later_bytes_per_tet = 1e12;
  EXPECT_THROW(mesh_surfaces(make_input({surface("sphere")}), options, nullptr), OutputError);
  MesherEstimate estimate;
  estimate.tets = std::numeric_limits<std::size_t>::max();
  EXPECT_THROW(validate_estimate(estimate), OutputError);
}

}  // namespace
}  // namespace tetwright::mesh_estimate_test

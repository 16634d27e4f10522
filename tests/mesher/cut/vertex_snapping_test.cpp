// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/vertex_snapping.h"

#include <gtest/gtest.h>

#include "mesher/cut/cutting.h"
#include "mesher/cut/link_topology.h"
#include "tests/mesher/fields.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"

namespace tetwright::vertex_snapping_test {
namespace {

LabelledLattice lattice_of(const MaterialField& field) {
  const Octree octree = build_octree(field, {false, 0.05}, field.interface_voxels(), {}, nullptr);
  LatticePoints points = lattice_points(octree);
  std::vector<NearestRegion> regions = lattice_regions(points, field);
  TetList tets = lattice_tets(octree, points);
  LabelledLattice lattice = label_lattice(std::move(points), std::move(regions), std::move(tets),
                                          field.regions().size(), false, nullptr);
  read_star_values(lattice, field);
  return lattice;
}

double bad_share(const LabelledLattice& lattice) {
  std::size_t count = 0, all = 0;
  for (const Tet& t : lattice.tets.all()) {
    if (!lattice.stars.lists(t[0]) && !lattice.stars.lists(t[1]) && !lattice.stars.lists(t[2]) &&
        !lattice.stars.lists(t[3]))
      continue;
    ++all;
    count += worst_piece_tangent(lattice, t) < 0.05;
  }
  return static_cast<double>(count) / static_cast<double>(all);
}

/// Expects a valid lattice, points on interfaces that lie on all sheets that meet there, and better pieces.
void expect_moves_well(const std::vector<TriangleMesh>& surfaces, double cell, double bad_after) {
  const auto field = make_field(surfaces, cell);
  LabelledLattice lattice = lattice_of(*field);
  const double before = bad_share(lattice);
  const SnapCounts counts = snap_vertices(lattice, *field, nullptr);
  EXPECT_GT(counts.moved, counts.candidates * 8 / 10);
  EXPECT_LT(bad_share(lattice), bad_after);
  EXPECT_GT(before, 0.1);

  const std::unique_ptr<FieldSampler> owned = field->sampler();
  FieldSampler& sampler = *owned;
  for (Index p : lattice.stars.points()) {
    if (!lattice.is_on[p]) continue;
    const auto regions = pure_regions(lattice, p);
    ASSERT_TRUE(regions);
    EXPECT_GE(regions->size(), 2);
    for (int k = 1; k < regions->size(); ++k) {
      Vec3 unused;
      EXPECT_LT(std::abs(sampler.between((*regions)[0], (*regions)[k], lattice.positions[p], unused)), 0.3);
    }
  }
  for (const Tet& t : lattice.tets.all()) {
    const auto& x = lattice.positions;
    ASSERT_GE(min_solid_angle(x[t[0]], x[t[1]], x[t[2]], x[t[3]]), 0.1 - 1e-12);
    ASSERT_FALSE(lattice.is_on[t[0]] && lattice.is_on[t[1]] && lattice.is_on[t[2]] && lattice.is_on[t[3]]);
  }
  const CutMesh mesh = cut_lattice(lattice);
  EXPECT_EQ(broken_promise(mesh.points, mesh.tets), "");
}

TEST(VertexSnapping, OneMaterial) { expect_moves_well({make_torus(1, 0.4)}, 0.07, 0.01); }

TEST(VertexSnapping, SeveralMaterials) {
  expect_moves_well({make_sphere(1.1), make_sphere(0.8), make_sphere(0.7, {0.8, 0.05, 0.1})}, 0.09, 0.04);
}

TEST(VertexSnapping, TheSameForAnyNumberOfThreads) {
  const auto field = make_field({make_sphere(1), make_sphere(0.8, {0.6, 0, 0})}, 0.09);
  const auto moved = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    LabelledLattice lattice = lattice_of(*field);
    snap_vertices(lattice, *field, nullptr);
    return lattice;
  };
  const LabelledLattice one = moved(1), four = moved(4);
  EXPECT_EQ(one.positions, four.positions);
  EXPECT_EQ(one.is_on, four.is_on);
}

}  // namespace
}  // namespace tetwright::vertex_snapping_test

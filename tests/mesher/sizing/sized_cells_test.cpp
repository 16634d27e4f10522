// SPDX-License-Identifier: Apache-2.0
#include "mesher/sizing/sized_cells.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/mesher/test_surfaces.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"

namespace tetwright::sized_cells_test {
namespace {

double longest_edge(const TetMesh& mesh, const Vec3& centre, double radius) {
  double longest = 0;
  for (const Tet& t : mesh.tets)
    for (const auto& e : tet_edges) {
      const Vec3 &p = mesh.points[t[e[0]]], &q = mesh.points[t[e[1]]];
      if (((p + q) / 2 - centre).norm() < radius) longest = std::max(longest, (q - p).norm());
    }
  return longest;
}

TEST(SizedCells, AreSmallWhereThatIsWanted) {
  std::vector<MaterialSurface> surfaces;
  surfaces.push_back({"ball", 1, make_sphere(1), "ball"});
  const MesherInput input = make_mesher_input(std::move(surfaces));
  const Vec3 centre = (input.low + input.high) / 2;
  const double radius = (input.high - input.low).maxCoeff() / 2;
  MesherOptions options;
  options.resolution = 24;
  const DenseMesh before = mesh_surfaces(input, options, nullptr);
  // Request cells smaller than a voxel in the middle of the ball only.
  const double wanted = 0.05 * radius;
  ASSERT_GT(before.report.cell_size, wanted);
  options.max_cell = [&](const Vec3& p) { return (p - centre).norm() < 0.3 * radius ? wanted : 10 * radius; };
  const DenseMesh after = mesh_surfaces(input, options, nullptr);
  EXPECT_TRUE(check_mesh(after.mesh).empty());
  // The longest edge of lattice tets is the edge of a cell.
  EXPECT_GT(longest_edge(before.mesh, centre, 0.25 * radius), 2 * wanted);
  EXPECT_LE(longest_edge(after.mesh, centre, 0.25 * radius), 1.0001 * wanted);
  // The outside of the body is not refined.
  EXPECT_LT(after.mesh.tets.size(), 12 * before.mesh.tets.size());
}

}  // namespace
}  // namespace tetwright::sized_cells_test

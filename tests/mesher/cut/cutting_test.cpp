// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/cutting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "common/random.h"
#include "tests/mesher/lattices.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::cutting_test {
namespace {

TEST(Cutting, CutsAreSharedAndOffTheEnds) {
  // The plane lies between two layers of points, almost on the upper one.
  LabelledLattice lattice = make_lattice([](const Vec3& p) { return p.z() < 2.75 ? 1 : 0; });
  for (Index p : lattice.stars.points()) {
    const float above = static_cast<float>(lattice.positions[p].z() - 2.9999);
    lattice.star_values(p)[0] = -above;
    lattice.star_values(p)[1] = above;
  }
  const CutMesh mesh = cut_lattice(lattice);
  EXPECT_EQ(mesh.regions.size(), mesh.tets.size());
  EXPECT_EQ(broken_promise(mesh.points, mesh.tets), "");
  double highest = 0, worst = 4;
  // Vertical edges above corners of cells would be cut at 2.9999.
  for (const Vec3& p : mesh.points)
    if (p.x() == std::floor(p.x()) && p.y() == std::floor(p.y())) highest = std::max(highest, p.z());
  EXPECT_NEAR(highest, 2.75, 1e-9);
  for (const Tet& t : mesh.tets)
    worst = std::min(worst, min_solid_angle_tangent(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]],
                                                    mesh.points[t[3]]));
  double expected = 4;
  for (const Tet& t : lattice.tets.all())
    if (lattice.stars.lists(t[0]) || lattice.stars.lists(t[1]) || lattice.stars.lists(t[2]) ||
        lattice.stars.lists(t[3]))
      expected = std::min(expected, worst_piece_tangent(lattice, t));
  EXPECT_EQ(worst, expected);
  // No point was moved, so the points on the interface are the cuts.
  ASSERT_EQ(mesh.on_interface.size(), mesh.points.size());
  std::size_t cuts = 0;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const bool is_lattice_point = std::find(lattice.positions.begin(), lattice.positions.end(),
                                            mesh.points[i]) != lattice.positions.end();
    EXPECT_EQ(mesh.on_interface[i] != 0, !is_lattice_point);
    cuts += mesh.on_interface[i];
  }
  EXPECT_GT(cuts, 0u);
}

// cut_lattice() and worst_piece_tangent() choose diagonals separately. If one of them used the diagonals of
// another tet, its angles would differ.
TEST(Cutting, EachTetHasTheAnglesOfItsOwnPieces) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Random random(seed);
    LabelledLattice lattice =
        make_lattice([&](const Vec3&) -> RegionIndex { return random.uniform() < 0.5 ? 1 : 0; });
    lattice.keep_outside = true;
    for (Index p : lattice.stars.points())
      for (float& value : lattice.star_values(p)) value *= static_cast<float>(0.1 + random.uniform());
    const CutMesh mesh = cut_lattice(lattice);
    EXPECT_EQ(broken_promise(mesh.points, mesh.tets), "");
    // The pieces are in the order of the tets, and their number follows from the regions of the corners.
    constexpr std::array<std::size_t, 5> piece_counts{1, 4, 6, 4, 1};
    std::size_t next = 0;
    for (const Tet& t : lattice.tets.all()) {
      std::size_t inside = 0;
      for (Index v : t) inside += lattice.region(v) == 1;
      double worst = 4;
      for (const std::size_t end = next + piece_counts[inside]; next < end; ++next) {
        ASSERT_LT(next, mesh.tets.size());
        const Tet& piece = mesh.tets[next];
        worst = std::min(worst, min_solid_angle_tangent(mesh.points[piece[0]], mesh.points[piece[1]],
                                                        mesh.points[piece[2]], mesh.points[piece[3]]));
      }
      ASSERT_EQ(worst, worst_piece_tangent(lattice, t));
    }
    EXPECT_EQ(next, mesh.tets.size());
  }
}

TEST(Cutting, FourRegionsMeetInAPoint) {
  LabelledLattice lattice = make_lattice([](const Vec3& p) -> RegionIndex {
    if (p.z() < 0.9 || p.z() > 5.1 || p.x() < 0.9 || p.x() > 5.1 || p.y() < 0.9 || p.y() > 5.1) return 0;
    return p.z() < 2.9 ? 4 : p.x() < 2.9 ? 1 : p.y() < 2.9 ? 2 : 3;
  });
  const CutMesh mesh = cut_lattice(lattice);
  EXPECT_EQ(broken_promise(mesh.points, mesh.tets), "");
  EXPECT_EQ(std::set<RegionIndex>(mesh.regions.begin(), mesh.regions.end()),
            (std::set<RegionIndex>{1, 2, 3, 4}));
  double kept = volume(mesh.points, mesh.tets);
  lattice.keep_outside = true;
  const CutMesh all = cut_lattice(lattice);
  EXPECT_EQ(broken_promise(all.points, all.tets), "");
  EXPECT_GT(volume(all.points, all.tets), kept);
  EXPECT_EQ(std::count(all.regions.begin(), all.regions.end(), 0) > 0, true);
}

}  // namespace
}  // namespace tetwright::cutting_test

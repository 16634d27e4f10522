#include "mesher/point_mover.h"

#include <gtest/gtest.h>

#include "common/quality.h"
#include "mesher/cutting.h"
#include "test_surfaces.h"

namespace tetwright {
namespace {

TEST(PointMover, KeepsTheLatticeSoundAndHelpsThePieces) {
  const ClosedSurface s = close_surface(make_torus(1, 0.4), "");
  const GridFrame frame = make_grid_frame(s.low, s.high, 0.07, false);
  const MaterialField field(s, {"", 1}, frame, nullptr);
  const Octree octree = build_octree(field, {false, 0.05}, nullptr);
  const LatticePoints points = lattice_points(octree);
  std::vector<Tet> tets = lattice_tets(octree, points);
  LabelledLattice lattice = label_lattice(points, lattice_distances(points, field), std::move(tets));

  const auto poor = [&] {
    std::size_t count = 0;
    for (const Tet& t : lattice.tets) count += worst_inside_angle(lattice, t) < 0.1;
    return static_cast<double>(count) / static_cast<double>(lattice.tets.size());
  };
  const double before = poor();
  const MoveCounts counts = move_points(lattice, field, nullptr);
  EXPECT_GT(counts.moved, counts.candidates * 9 / 10);
  EXPECT_LT(poor(), 0.01);
  EXPECT_GT(before, 0.1);

  FieldSampler sampler(field);
  for (Index p = 0; p < lattice.positions.size(); ++p) {
    if (lattice.sides[p] == Side::on) {
      EXPECT_LT(std::abs(sampler.at(lattice.positions[p])), 0.3);
    }
  }
  for (const Tet& t : lattice.tets) {
    const auto& x = lattice.positions;
    ASSERT_GE(min_solid_angle(x[t[0]], x[t[1]], x[t[2]], x[t[3]]), 0.1);
    const auto on = [&](Index v) { return lattice.sides[v] == Side::on; };
    ASSERT_FALSE(on(t[0]) && on(t[1]) && on(t[2]) && on(t[3]));
  }
  const CutMesh mesh = cut_lattice(lattice);
  EXPECT_EQ(broken_promise(mesh.points, mesh.tets), "");
}

}  // namespace
}  // namespace tetwright

#include "mesher/arrangement.h"

#include <gtest/gtest.h>

#include <functional>

namespace tetwright {
namespace {

/// The lattice of 6 x 6 x 6 equal cells with sides by a function of the position.
LabelledLattice make_lattice(const std::function<bool(const Vec3&)>& inside) {
  const Octree octree =
      build_octree({6, 6, 6}, 0, [](int, const std::vector<MortonKey>&) { return std::vector<MortonKey>(); });
  LatticePoints points = lattice_points(octree);
  std::vector<float> distances;
  for (const Vec3& p : points.positions) distances.push_back(inside(p) ? -1.0f : 1.0f);
  std::vector<Tet> tets = lattice_tets(octree, points);
  return label_lattice(std::move(points), std::move(distances), std::move(tets));
}

Index at(const LabelledLattice& lattice, const Vec3& p) {
  for (Index i = 0; i < lattice.positions.size(); ++i)
    if (lattice.positions[i] == p) return i;
  return no_index;
}

TEST(Arrangement, FlatInterface) {
  LabelledLattice lattice = make_lattice([](const Vec3& p) { return p.z() < 2.75; });
  const StarMap stars(lattice);
  // All of the layer above may go onto the interface, one after another, and then none of the layer below:
  // tets between the two would have all four points on it, or edges lose their side.
  for (Index p : std::vector<Index>(lattice.near_points)) {
    const Vec3 x = lattice.positions[p];
    if (x.z() != 3 || x.x() < 2 || x.x() > 4 || x.y() < 2 || x.y() > 4) continue;
    EXPECT_TRUE(may_move_onto_interface(lattice, stars, p));
    lattice.sides[p] = Side::on;
  }
  EXPECT_TRUE(may_move_onto_interface(lattice, stars, at(lattice, {1.5, 1.5, 2.5})));
}

TEST(Arrangement, AThinWallKeepsItsInside) {
  LabelledLattice lattice = make_lattice([](const Vec3& p) { return p.z() == 3; });
  const StarMap stars(lattice);
  const Index p = at(lattice, {3, 3, 3});
  ASSERT_NE(p, no_index);
  EXPECT_FALSE(may_move_onto_interface(lattice, stars, p));  // outside lies on both sides of it
}

TEST(Arrangement, ASinglePointInsideStays) {
  LabelledLattice lattice = make_lattice([](const Vec3& p) { return p == Vec3(3, 3, 3); });
  const StarMap stars(lattice);
  EXPECT_FALSE(may_move_onto_interface(lattice, stars, at(lattice, {3, 3, 3})));
}

TEST(Arrangement, ANeckIsNotClosed) {
  // A rod of one point across: its points have inside at two ends.
  LabelledLattice lattice = make_lattice([](const Vec3& p) { return p.x() == 3 && p.y() == 3; });
  const StarMap stars(lattice);
  EXPECT_FALSE(may_move_onto_interface(lattice, stars, at(lattice, {3, 3, 3})));
}

TEST(Arrangement, NoTetLiesFlatOnTheInterface) {
  LabelledLattice lattice = make_lattice([](const Vec3& p) { return p.z() < 2.75; });
  const StarMap stars(lattice);
  const Index p = at(lattice, {3, 3, 3});
  const Tet tet = lattice.tets[*stars.begin(p)];
  for (Index v : tet)
    if (v != p) lattice.sides[v] = Side::on;
  EXPECT_FALSE(may_move_onto_interface(lattice, stars, p));
}

}  // namespace
}  // namespace tetwright

#include "mesher/labelled_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace tetwright {
namespace {

LabelledLattice make_lattice(const std::function<bool(const Vec3&)>& inside) {
  const Octree octree =
      build_octree({6, 6, 6}, 0, [](int, const std::vector<MortonKey>&) { return std::vector<MortonKey>(); });
  LatticePoints points = lattice_points(octree);
  std::vector<float> distances;
  for (const Vec3& p : points.positions) distances.push_back(inside(p) ? -1.0f : 1.0f);
  std::vector<Tet> tets = lattice_tets(octree, points);
  return label_lattice(std::move(points), std::move(distances), std::move(tets));
}

std::ptrdiff_t inside_count(const LabelledLattice& lattice) {
  return std::count(lattice.sides.begin(), lattice.sides.end(), Side::inside);
}

TEST(LabelledLattice, DropsTetsFarOutside) {
  const LabelledLattice lattice =
      make_lattice([](const Vec3& p) { return (p - Vec3(2, 2, 2)).norm() < 1.2; });
  EXPECT_LT(lattice.tets.size(), 3u * 180u * 4u + 6u * 36u * 4u);
  for (const Tet& t : lattice.tets)
    EXPECT_TRUE(std::any_of(t.begin(), t.end(), [&](Index v) {
      return lattice.sides[v] == Side::inside ||
             std::binary_search(lattice.near_points.begin(), lattice.near_points.end(), v);
    }));
}

TEST(LabelledLattice, StarMapListsEveryTetOfAPoint) {
  const LabelledLattice lattice = make_lattice([](const Vec3& p) { return p.x() < 2.7; });
  const StarMap stars(lattice);
  for (Index p : lattice.near_points) {
    std::vector<Index> expected;
    for (Index t = 0; t < lattice.tets.size(); ++t)
      if (std::count(lattice.tets[t].begin(), lattice.tets[t].end(), p)) expected.push_back(t);
    EXPECT_EQ(std::vector<Index>(stars.begin(p), stars.end(p)), expected);
  }
}

TEST(LabelledLattice, SpecksGoAndPairsStay) {
  LabelledLattice speck = make_lattice([](const Vec3& p) { return p == Vec3(3, 3, 3); });
  EXPECT_EQ(remove_specks(speck), 1u);
  EXPECT_EQ(inside_count(speck), 0);
  LabelledLattice cavity = make_lattice([](const Vec3& p) { return p.x() < 5 && p != Vec3(3, 3, 3); });
  const auto before = inside_count(cavity);
  EXPECT_EQ(remove_specks(cavity), 1u);
  EXPECT_EQ(inside_count(cavity), before + 1);
  LabelledLattice pair = make_lattice([](const Vec3& p) { return p == Vec3(3, 3, 3) || p == Vec3(3, 3, 2); });
  EXPECT_EQ(remove_specks(pair), 0u);
  EXPECT_EQ(inside_count(pair), 2);
}

}  // namespace
}  // namespace tetwright

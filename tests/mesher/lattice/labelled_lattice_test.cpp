// SPDX-License-Identifier: Apache-2.0
#include "mesher/lattice/labelled_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/random.h"
#include "tests/mesher/lattices.h"

namespace tetwright::labelled_lattice_test {
namespace {

std::ptrdiff_t count_of(const LabelledLattice& lattice, RegionIndex region) {
  return std::count(lattice.first_region.begin(), lattice.first_region.end(), region);
}

TEST(LabelledLattice, DropsTetsFarOutside) {
  const LabelledLattice lattice =
      make_lattice([](const Vec3& p) { return (p - Vec3(2, 2, 2)).norm() < 1.2 ? 1 : 0; });
  EXPECT_LT(lattice.tets.size(), 3u * 180u * 4u + 6u * 36u * 4u);
  for (const Tet& t : lattice.tets.all())
    EXPECT_TRUE(std::any_of(t.begin(), t.end(),
                            [&](Index v) { return lattice.first_region[v] == 1 || lattice.stars.lists(v); }));
}

TEST(LabelledLattice, StarMapListsEveryTetOfAPoint) {
  const LabelledLattice lattice = make_lattice([](const Vec3& p) { return p.x() < 2.7 ? 1 : 0; });
  for (Index p : lattice.stars.points()) {
    std::vector<Index> expected;
    for (Index t = 0; t < lattice.tets.size(); ++t)
      if (std::count(lattice.tets[t].begin(), lattice.tets[t].end(), p)) expected.push_back(t);
    const auto listed = lattice.stars.tets(p);
    EXPECT_EQ(std::vector<Index>(listed.begin(), listed.end()), expected);
  }
}

TEST(LabelledLattice, StarMapsOfManyChunksAndLongSteps) {
  // Tets that return to the same points after one, a hundred, ten thousand and more others.
  constexpr Index points = 4 * 4096 + 3;
  std::vector<std::vector<Tet>> parts(5);
  Random random(3);
  std::vector<std::vector<Index>> expected(points);
  Index t = 0;
  for (std::vector<Tet>& part : parts)
    for (int i = 0; i < 17001; ++i, ++t) {
      const Index wide = random.below(points - 4), narrow = t / 100 % 5000;
      part.push_back({wide, wide + 1, wide + 2,
                      narrow == wide + 1 || narrow == wide + 2 || narrow == wide ? wide + 3 : narrow});
      for (Index p : part.back()) expected[p].push_back(t);
    }
  TetList tets(std::move(parts));
  std::vector<Index> listed;
  for (Index p = 0; p < points; ++p)
    if (p % 7) listed.push_back(p);
  const StarMap stars(listed, points, tets);
  for (Index p = 0; p < points; ++p) {
    ASSERT_EQ(stars.lists(p), p % 7 != 0);
    if (!stars.lists(p)) continue;
    const auto row = stars.tets(p);
    ASSERT_EQ(std::vector<Index>(row.begin(), row.end()), expected[p]) << p;
  }
}

TEST(LabelledLattice, ListsOfTetsInPieces) {
  const auto make = [] {
    std::vector<std::vector<Tet>> parts(3);
    Index t = 0;
    for (std::size_t size : {TetList::piece_size / 3, std::size_t{0}, 2 * TetList::piece_size + 5}) {
      std::vector<Tet>& part = parts[t ? 2 : 0];
      for (std::size_t i = 0; i < size; ++i, ++t) part.push_back({t, t + 1, t + 2, t + 3});
    }
    return TetList(std::move(parts));
  };
  TetList tets = make();
  ASSERT_EQ(tets.size(), TetList::piece_size / 3 + 2 * TetList::piece_size + 5);
  ASSERT_EQ(tets.piece_count(), 3u);
  for (std::size_t i = 0; i < tets.size(); ++i) ASSERT_EQ(tets[i][0], i);
  tets.keep_if([](const Tet& t) { return t[0] % 3 == 1; });
  ASSERT_EQ(tets.size(), tets.all().size());
  for (std::size_t i = 0; i < tets.size(); ++i) ASSERT_EQ(tets[i][0], 3 * i + 1);
  tets.keep_if([](const Tet&) { return false; });
  EXPECT_EQ(tets.size(), 0u);
  EXPECT_EQ(TetList().all().size(), 0u);
}

TEST(LabelledLattice, StarRegionsAreThoseOfTheClosedStar) {
  const LabelledLattice lattice = make_lattice([](const Vec3& p) {
    return p.x() < 2.7 ? 1 : p.y() < 3.2 ? 2 : p.z() < 3.1 ? 0 : 3;
  });
  for (Index p : lattice.stars.points()) {
    std::vector<RegionIndex> expected;
    for (Index t : lattice.stars.tets(p))
      for (Index v : lattice.tets[t]) expected.push_back(lattice.first_region[v]);
    std::sort(expected.begin(), expected.end());
    expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
    const auto listed = lattice.star_regions(p);
    EXPECT_EQ(std::vector<RegionIndex>(listed.begin(), listed.end()), expected);
  }
}

TEST(LabelledLattice, CutsAreWhereTwoRegionsAreEquallyNear) {
  LabelledLattice lattice = make_lattice([](const Vec3& p) { return p.x() < 2.9 ? 1 : 0; });
  const Index p = point_at(lattice, {2, 3, 3}), q = point_at(lattice, {3, 3, 3});
  const auto set = [&](Index point, float outside, float inside) {
    lattice.star_values(point)[0] = outside;
    lattice.star_values(point)[1] = inside;
  };
  set(p, 0.5f, -1.5f);
  set(q, -3.0f, 3.0f);
  EXPECT_FLOAT_EQ(lattice.gap(p, 1, 0), 2);
  EXPECT_FLOAT_EQ(lattice.gap(q, 1, 0), -6);
  EXPECT_FLOAT_EQ(lattice.margin(p), 2);
  EXPECT_DOUBLE_EQ(lattice.cut_share(p, 1, q, 0), 0.25);
  EXPECT_DOUBLE_EQ(lattice.cut_share(q, 0, p, 1), 0.75);
}

TEST(LabelledLattice, SpecksGoAndPairsStay) {
  std::size_t isolated_vertices = 0;
  const auto isolated_vertex =
      make_lattice([](const Vec3& p) { return p == Vec3(3, 3, 3) ? 1 : 0; }, &isolated_vertices);
  EXPECT_EQ(isolated_vertices, 1u);
  EXPECT_EQ(count_of(isolated_vertex, 1), 0);
  const auto solid = make_lattice([](const Vec3& p) { return p.x() < 5 ? 1 : 0; });
  const auto cavity =
      make_lattice([](const Vec3& p) { return p.x() < 5 && p != Vec3(3, 3, 3) ? 1 : 0; }, &isolated_vertices);
  EXPECT_EQ(isolated_vertices, 1u);
  EXPECT_EQ(count_of(cavity, 1), count_of(solid, 1));
  const auto pair = make_lattice(
      [](const Vec3& p) { return p == Vec3(3, 3, 3) || p == Vec3(3, 3, 2) ? 1 : 0; }, &isolated_vertices);
  EXPECT_EQ(isolated_vertices, 0u);
  EXPECT_EQ(count_of(pair, 1), 2);
  // Among several regions the one of most neighbours is chosen.
  const auto third = make_lattice([](const Vec3& p) { return p == Vec3(3, 3, 3) ? 3
                                                             : p.z() < 3.2      ? 2
                                                                                : 1; },
                                  &isolated_vertices);
  EXPECT_EQ(isolated_vertices, 1u);
  EXPECT_EQ(third.first_region[point_at(third, {3, 3, 3})], 2);
}

}  // namespace
}  // namespace tetwright::labelled_lattice_test

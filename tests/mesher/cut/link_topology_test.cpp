// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/link_topology.h"

#include <gtest/gtest.h>

#include "tests/mesher/lattices.h"

namespace tetwright::link_topology_test {
namespace {

std::vector<int> meeting(const LabelledLattice& lattice, const Vec3& p) {
  const auto regions = regions_if_moved(lattice, point_at(lattice, p));
  return regions ? std::vector<int>(regions->begin(), regions->end()) : std::vector<int>{};
}

using Regions = std::vector<int>;

TEST(LinkTopology, FlatInterface) {
  LabelledLattice lattice = make_lattice([](const Vec3& p) { return p.z() < 2.75 ? 1 : 0; });
  // All points of the layer above may move onto the interface, one after another.
  for (Index p : std::vector<Index>(lattice.stars.points())) {
    const Vec3 x = lattice.positions[p];
    if (x.z() != 3 || x.x() < 2 || x.x() > 4 || x.y() < 2 || x.y() > 4) continue;
    EXPECT_TRUE(regions_if_moved(lattice, p));
    lattice.is_on[p] = 1;
  }
  EXPECT_EQ(meeting(lattice, {1.5, 1.5, 2.5}), (Regions{0, 1}));
}

TEST(LinkTopology, AThinWallKeepsItsInside) {
  // The outside is on both sides of the wall.
  EXPECT_EQ(meeting(make_lattice([](const Vec3& p) { return p.z() == 3 ? 1 : 0; }), {3, 3, 3}), Regions{});
  // For a sheet between two materials the other side is another region.
  EXPECT_EQ(
      meeting(make_lattice([](const Vec3& p) { return p.z() == 3  ? 1
                                                      : p.z() < 3 ? 2
                                                                  : 0; }), {3, 3, 3}),
      Regions{});
}

TEST(LinkTopology, ANeckIsNotClosed) {
  // A rod one point thick: each point has inside neighbours at both ends.
  EXPECT_EQ(meeting(make_lattice([](const Vec3& p) { return p.x() == 3 && p.y() == 3 ? 1 : 0; }), {3, 3, 3}),
            Regions{});
}

TEST(LinkTopology, NoTetLiesFlatOnTheInterface) {
  LabelledLattice lattice = make_lattice([](const Vec3& p) { return p.z() < 2.75 ? 1 : 0; });
  const Index p = point_at(lattice, {3, 3, 3});
  for (Index v : lattice.tets[*lattice.stars.tets(p).begin()])
    if (v != p) lattice.is_on[v] = 1;
  EXPECT_FALSE(regions_if_moved(lattice, p));
}

TEST(LinkTopology, JunctionCurvesAndCorners) {
  const auto wedge = [](const Vec3& p) -> RegionIndex { return p.x() < 2.9 ? 0 : p.y() < 2.9 ? 1 : 2; };
  EXPECT_EQ(meeting(make_lattice(wedge), {3, 3, 3}), (Regions{0, 1, 2}));
  EXPECT_EQ(meeting(make_lattice(wedge), {3, 5, 3}), (Regions{0, 2}));
  const auto corner = [&](const Vec3& p) -> RegionIndex { return p.z() < 2.9 ? 3 : wedge(p); };
  EXPECT_EQ(meeting(make_lattice(corner), {3, 3, 3}), (Regions{0, 1, 2, 3}));
  // More than four regions do not meet in general position.
  const auto many = [&](const Vec3& p) -> RegionIndex {
    return p.z() < 2.9 && p.x() < 2.9 ? 4 : p.z() < 2.9 ? 3 : wedge(p);
  };
  EXPECT_EQ(meeting(make_lattice(many), {3, 3, 3}), Regions{});
}

TEST(LinkTopology, ARingAroundThePointIsNoDisc) {
  // Outside above, a ring of 1 at the height of the point, 2 below: 1 surrounds the point, and 2 appears
  // inside the ring.
  const auto ring = [](const Vec3& p) -> RegionIndex { return p.z() > 3 ? 0 : p.z() == 3 ? 1 : 2; };
  const LabelledLattice lattice =
      make_lattice([&](const Vec3& p) { return p == Vec3(3, 3, 3) ? RegionIndex{0} : ring(p); });
  EXPECT_EQ(meeting(lattice, {3, 3, 3}), Regions{});
}

TEST(LinkTopology, RegionsDoNotAlternateAroundAnEdge) {
  // Around the edge between two points on interfaces: 1, outside, 2, then outside again or a fourth region.
  const auto meeting_with = [](RegionIndex fourth) {
    LabelledLattice lattice = make_lattice([&](const Vec3& p) -> RegionIndex {
      if (p.z() >= 4 || p.z() <= 1 || (p.x() == 3 && p.y() == 3)) return 0;
      if (p.x() >= 3 && p.y() >= 3) return 1;
      if (p.x() <= 3 && p.y() <= 3) return 2;
      return p.x() > 3 ? 0 : fourth;
    });
    lattice.is_on[point_at(lattice, {3, 3, 2})] = 1;
    return meeting(lattice, {3, 3, 3});
  };
  EXPECT_EQ(meeting_with(0), Regions{});
  EXPECT_EQ(meeting_with(3), (Regions{0, 1, 2, 3}));
}

TEST(LinkTopology, PureRegionsOfTheClosedStar) {
  LabelledLattice lattice = make_lattice([](const Vec3& p) { return p.z() < 2.75 ? 1 : 0; });
  const Index p = point_at(lattice, {3, 3, 3});
  EXPECT_EQ(pure_regions(lattice, p)->size(), 2);
  for (Index t : lattice.stars.tets(p))
    for (Index v : lattice.tets[t])
      if (lattice.first_region[v] == 1) lattice.is_on[v] = 1;
  EXPECT_EQ(pure_regions(lattice, p)->size(), 1);
}

}  // namespace
}  // namespace tetwright::link_topology_test

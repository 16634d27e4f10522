// SPDX-License-Identifier: Apache-2.0
#include "simplify/remesh/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/simplify/meshes.h"

namespace tetwright::point_tree_test {
namespace {

/// A mesh whose points are moved list by list, and the tree that follows.
struct Bench {
  explicit Bench(int n) : mesh(grid_mesh(n), "mesh") { tree.build(mesh); }

  template <class Place>
  void move(const std::vector<Index>& points, const Place& place) {
    std::vector<ChangeJournal::OldPoint> old;
    for (const Index p : points) old.push_back({p, true, mesh.position(p)});
    for (const Index p : points) mesh.set_position(p, place(mesh.position(p)));
    tree.repair(mesh, old);
  }

  void expect_found(const Box3& box) const {
    std::vector<Index> expected, found = tree.points_in(mesh, box);
    for (Index p = 0; p < mesh.point_slots(); ++p)
      if (mesh.incident_tet(p) != no_index && box.contains(mesh.position(p))) expected.push_back(p);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
  }

  std::vector<Index> all() const {
    std::vector<Index> points(mesh.point_slots());
    for (Index p = 0; p < points.size(); ++p) points[p] = p;
    return points;
  }

  EditableMesh mesh;
  PointTree tree;
};

Vec3 anywhere(Random& random) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return {2 * x, 2 * y, 2 * z};
}

TEST(PointTree, FollowsPointsThatMove) {
  Bench b(7);
  Random random(1);
  for (int round = 0; round < 40; ++round) {
    std::vector<Index> some = b.all();
    random.shuffle(std::span(some));
    some.resize(1 + random.below(200));
    if (round % 3 == 0) {
      b.move(some, [&](const Vec3&) { return anywhere(random); });
    } else {  // a little, onto lattice planes
      b.move(some, [&](const Vec3& p) -> Vec3 { return (8 * p).array().round() / 8; });
    }
    const Vec3 c = anywhere(random), d = anywhere(random);
    b.expect_found({c.cwiseMin(d), c.cwiseMax(d)});
    b.expect_found({c, c});
  }
}

TEST(PointTree, TakesManyPointsAtOnePlace) {
  Bench b(5);
  b.move(b.all(), [](const Vec3&) { return Vec3(0.5, 0.5, 0.5); });
  b.expect_found({Vec3(0.5, 0.5, 0.5), Vec3(0.5, 0.5, 0.5)});
  b.expect_found({Vec3(0.6, 0, 0), Vec3(1, 1, 1)});
  Random random(2);
  b.move(b.all(), [&](const Vec3&) { return anywhere(random); });
  b.expect_found({Vec3(0.2, 0.2, 0.2), Vec3(1.4, 1, 1)});
}

TEST(PointTree, StaysSmallWhenTheBodyTravels) {
  Bench b(7);
  const std::size_t nodes = b.tree.node_slots();
  // Slice by slice, so that the tree is never rebuilt.
  for (int step = 1; step <= 300; ++step)
    for (int part = 0; part < 4; ++part) {
      std::vector<Index> points;
      for (const Index p : b.all())
        if (p % 4 == static_cast<Index>(part)) points.push_back(p);
      b.move(points, [](const Vec3& p) { return Vec3(p + Vec3(0.3, 0.1, 0)); });
    }
  EXPECT_LE(b.tree.node_slots(), 3 * nodes);
  const Vec3 middle(300 * 0.3 + 0.5, 300 * 0.1 + 0.5, 0.5);
  b.expect_found({middle - Vec3::Constant(0.3), middle + Vec3::Constant(0.3)});
}

}  // namespace
}  // namespace tetwright::point_tree_test

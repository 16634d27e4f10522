// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/edge_ring.h"

#include "tests/simplify/rings.h"
#include "tests/simplify/workbench.h"

namespace tetwright::edge_ring_test {
namespace {

/// Index into tet_edges of the axis in tet t.
int axis_of(const Workbench& w, Index t, Index low, Index high) {
  const Tet& p = w.mesh.points(t);
  for (int e = 0; e < 6; ++e) {
    const Index a = p[tet_edges[e][0]], b = p[tet_edges[e][1]];
    if ((a == low && b == high) || (a == high && b == low)) return e;
  }
  ADD_FAILURE() << "no such edge";
  return 0;
}

void gather(Workbench& w, Index t, double height) {
  ASSERT_EQ(w.ws->ring.gather(w.mesh, t, axis_of(w, t, w.at(0, 0, -height), w.at(0, 0, height))),
            Outcome::done);
}

void expect_positive_in_order(const Workbench& w) {
  const EdgeRing& r = w.ws->ring;
  ASSERT_EQ(r.points.size(), r.closed ? r.tets.size() : r.tets.size() + 1);
  for (std::size_t i = 0; i < r.tets.size(); ++i) {
    const Index p = r.points[i], q = r.points[(i + 1) % r.points.size()];
    EXPECT_EQ(orient3d(w.mesh.position(r.a), w.mesh.position(r.b), w.mesh.position(p), w.mesh.position(q)),
              1);
    for (Index v : {r.a, r.b, p, q}) {
      const Tet& t = w.mesh.points(r.tets[i]);
      EXPECT_NE(std::find(t.begin(), t.end(), v), t.end());
    }
  }
}

TEST(EdgeRing, ClosesAroundAnInnerEdgeFromEveryTet) {
  for (Index t = 0; t < 5; ++t) {
    Workbench w(ring_mesh(5, 1));
    gather(w, t, 1);
    EXPECT_TRUE(w.ws->ring.closed);
    EXPECT_EQ(w.ws->ring.tets.size(), 5u);
    EXPECT_EQ(w.ws->ring.dimension(), 3);
    expect_positive_in_order(w);
    w.expect_sound();
  }
}

TEST(EdgeRing, IsAChainOnTheBoundaryFromEveryTet) {
  for (Index t = 0; t < 4; ++t) {
    Workbench w(ring_mesh(4, 1, true));
    gather(w, t, 1);
    EXPECT_FALSE(w.ws->ring.closed);
    EXPECT_EQ(w.ws->ring.tets.size(), 4u);
    EXPECT_EQ(w.ws->ring.dimension(), 2);
    expect_positive_in_order(w);
  }
}

TEST(EdgeRing, CountsSheetsAndBeginsAtOne) {
  Workbench two(ring_mesh(6, 1, false, 0, [](int i) { return MaterialTag(i < 2 ? 1 : 2); }));
  gather(two, 3, 1);
  EXPECT_EQ(two.ws->ring.dimension(), 2);
  two.ws->ring.begin_at_interface();
  const EdgeRing& r = two.ws->ring;
  EXPECT_NE(r.regions.front(), r.regions.back());
  expect_positive_in_order(two);

  Workbench three(ring_mesh(6, 1, false, 0, [](int i) { return MaterialTag(i / 2); }));
  gather(three, 0, 1);
  EXPECT_EQ(three.ws->ring.interface_triangles, 3);
  EXPECT_EQ(three.ws->ring.dimension(), 1);

  Workbench inner_sheet(
      ring_mesh(4, 1, true, std::numbers::pi, [](int i) { return MaterialTag(i < 2 ? 1 : 2); }));
  gather(inner_sheet, 0, 1);
  EXPECT_EQ(inner_sheet.ws->ring.dimension(), 1);
}

TEST(EdgeRing, TellsTooManyTets) {
  Workbench many(ring_mesh(20, 1));
  EXPECT_EQ(many.ws->ring.gather(many.mesh, 0, axis_of(many, 0, many.at(0, 0, -1), many.at(0, 0, 1))),
            Outcome::too_large);
}

}  // namespace
}  // namespace tetwright::edge_ring_test

#include "simplify/collapse.h"

#include "tests/simplify/workbench.h"

namespace tetwright {
namespace {

using Tag = std::optional<MaterialTag>;

TEST(Collapse, RemovesAnInnerPointAndItsEdgesTets) {
  TetMesh mesh = grid_mesh(4);
  jitter(mesh, 1);
  Workbench w(mesh);
  w.rules.accept_worse = 1;
  const Index p = w.at(mesh.points[62].x(), mesh.points[62].y(), mesh.points[62].z());
  w.star(p);
  ASSERT_EQ(collapse(*w.task, w.rules), Outcome::done);
  EXPECT_LT(w.mesh.live_tets(), mesh.tets.size());
  EXPECT_EQ(w.mesh.hint(p), no_index);
  w.expect_sound();
}

// Collapsing everything that may be collapsed, again and again, must keep the mesh sound throughout.
void collapse_all(Workbench& w) {
  w.rules.accept_worse = 1;
  bool any = true;
  while (any) {
    any = false;
    for (Index p = 0; p < w.mesh.point_slots(); ++p) {
      if (w.mesh.hint(p) == no_index) continue;
      w.star(p);
      any |= collapse(*w.task, w.rules) == Outcome::done;
      w.task->release();
    }
    w.expect_sound();
  }
}

TEST(Collapse, ABallCollapsesToVeryFewTets) {
  TetMesh mesh = grid_mesh(4);
  jitter(mesh, 2);
  Workbench w(mesh);
  collapse_all(w);
  EXPECT_LT(w.mesh.live_tets(), 60u);
  EXPECT_GE(w.mesh.live_tets(), 1u);
}

TEST(Collapse, ARingKeepsItsHole) {
  TetMesh mesh = grid_mesh(
      {6, 6, 2}, [](int x, int y, int) { return x >= 2 && x < 4 && y >= 2 && y < 4 ? Tag() : Tag(1); });
  jitter(mesh, 3);
  Workbench w(mesh);
  collapse_all(w);
  // Euler characteristic of the solid: points - edges + faces - tets = 0 for a ring, 1 for a ball.
  const TetMesh after = std::move(w.mesh).to_mesh();
  std::vector<std::pair<Index, Index>> edges;
  std::vector<Triangle> faces;
  for (const Tet& t : after.tets) {
    for (const auto& e : tet_edges) edges.push_back(std::minmax(t[e[0]], t[e[1]]));
    for (const auto& f : tet_faces) {
      Triangle s{t[f[0]], t[f[1]], t[f[2]]};
      std::sort(s.begin(), s.end());
      faces.push_back(s);
    }
  }
  const auto distinct = [](auto& list) {
    std::sort(list.begin(), list.end());
    return static_cast<long>(std::unique(list.begin(), list.end()) - list.begin());
  };
  EXPECT_EQ(static_cast<long>(after.points.size()) - distinct(edges) + distinct(faces) -
                static_cast<long>(after.tets.size()),
            0);
}

TEST(Collapse, ALayerOneCubeThickSurvives) {
  // Its tets span from one side to the other: every edge across is a spanning one.
  TetMesh mesh = grid_mesh({4, 4, 5}, [](int, int, int z) { return Tag(z == 2 ? 2 : z < 2 ? 1 : 3); });
  jitter(mesh, 4);
  Workbench w(mesh);
  collapse_all(w);
  const TetMesh after = std::move(w.mesh).to_mesh();
  double layer = 0;
  std::vector<std::pair<MaterialTag, MaterialTag>> touching;
  for (std::size_t t = 0; t < after.tets.size(); ++t) {
    const Tet& p = after.tets[t];
    if (after.materials[t] == 2)
      layer += tet_volume(after.points[p[0]], after.points[p[1]], after.points[p[2]], after.points[p[3]]);
    for (std::size_t u = 0; u < t; ++u) {
      int common = 0;
      for (Index a : after.tets[u]) common += std::count(p.begin(), p.end(), a) > 0;
      if (common > 0) touching.push_back(std::minmax(after.materials[t], after.materials[u]));
    }
  }
  EXPECT_GT(layer, 1);
  // The layer never tears: what is below it and what is above share not even a point.
  EXPECT_EQ(std::count(touching.begin(), touching.end(), std::pair<MaterialTag, MaterialTag>(1, 3)), 0);
  EXPECT_GT(std::count(touching.begin(), touching.end(), std::pair<MaterialTag, MaterialTag>(1, 2)), 0);
}

TEST(Collapse, CornersStay) {
  Workbench w(grid_mesh({4, 4, 4}, [](int x, int y, int z) {
    return Tag(z < 2 ? 1 : x < 2 ? 2 : y < 2 ? 3 : 4);
  }));
  w.rules.accept_worse = 1;
  w.star(w.at(2, 2, 2));
  EXPECT_EQ(collapse(*w.task, w.rules), Outcome::material_rule);
  w.expect_sound();
}

TEST(Collapse, AnErrorAboveEIsRefused) {
  TetMesh mesh = grid_mesh(4);
  jitter(mesh, 5);
  Workbench w(mesh);
  w.rules.accept_worse = 1;
  w.rules.largest_error = 1e-3 * w.mesh.scale();  // far below an edge
  w.star(0);
  EXPECT_EQ(collapse(*w.task, w.rules), Outcome::surface_error);
  w.expect_sound();
}

TEST(Collapse, ATakenGridCellIsToldAndNothingChanges) {
  TetMesh mesh = grid_mesh(4);
  jitter(mesh, 6);
  Workbench w(mesh);
  w.rules.accept_worse = 1;
  for (std::size_t c = 0; c < w.grid.locks().size(); ++c) ASSERT_TRUE(w.grid.locks().try_lock(c));
  int taken = 0;
  for (Index p = 0; p < w.mesh.point_slots(); ++p)
    if (!w.star(p).sheets.empty()) taken += collapse(*w.task, w.rules) == Outcome::lock_taken;
  EXPECT_GT(taken, 0);
  EXPECT_EQ(w.mesh.live_tets(), mesh.tets.size());
  for (std::size_t c = 0; c < w.grid.locks().size(); ++c) w.grid.locks().unlock(c);
  w.expect_sound();
}

}  // namespace
}  // namespace tetwright

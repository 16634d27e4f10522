#include "simplify/constraints/surface_grid.h"

#include "tests/simplify/workbench.h"

namespace tetwright::surface_grid_test {
namespace {

using Tag = std::optional<MaterialTag>;

TEST(SurfaceGrid, ListsBoundaryAndInterfaces) {
  Workbench w(grid_mesh({4, 4, 4}, [](int x, int, int) { return Tag(x < 2 ? 1 : 2); }));
  EXPECT_EQ(w.grid.triangles().size(), 2u * 16 * 6 + 2u * 16);
}

/// A triangle of the grid at the edge of nothing: three points of the boundary, ids as in the mesh.
MeshTriangle boundary_triangle(const Workbench& w) {
  for (Index t = 0; t < w.mesh.tet_slots(); ++t) {
    if (w.mesh.dead(t)) continue;
    for (int f = 0; f < 4; ++f)
      if (w.mesh.neighbour(t, f) == no_index) {
        MeshTriangle out;
        for (int k = 0; k < 3; ++k) {
          out.ids[k] = w.mesh.tet(t).points[tet_faces[f][k]];
          out.points[k] = w.mesh.position(out.ids[k]);
        }
        return out;
      }
  }
  ADD_FAILURE();
  return {};
}

TEST(SurfaceGrid, ATriangleThatWouldCrossAnotherIsRefused) {
  Workbench w(grid_mesh(4));
  SurfaceGrid::Edit edit;
  edit.removed = {boundary_triangle(w)};
  // In its stead one that pierces the whole cube.
  const double s = w.mesh.space().scale();
  edit.added = {
      {edit.removed[0].ids, {Vec3(-1, 2.1, 2.2) * s, Vec3(5, 2.1, 2.2) * s, Vec3(5, 2.6, 2.4) * s}}};
  HeldLocks held(w.grid.locks());
  SurfaceGrid::Workspace ws;
  EXPECT_EQ(w.grid.begin_edit(edit, ws, held), Outcome::self_intersection);
  held.release();
  w.expect_sound();
}

TEST(SurfaceGrid, AHarmlessTriangleReplacesAnother) {
  Workbench w(grid_mesh(4));
  SurfaceGrid::Edit edit;
  const MeshTriangle before = boundary_triangle(w);
  edit.removed = {before};
  const double s = w.mesh.space().scale();
  MeshTriangle after{before.ids, {Vec3(9, 9, 9) * s, Vec3(10, 9, 9) * s, Vec3(9, 10, 9) * s}};
  edit.added = {after};
  HeldLocks held(w.grid.locks());
  SurfaceGrid::Workspace ws;
  ASSERT_EQ(w.grid.begin_edit(edit, ws, held), Outcome::done);
  w.grid.commit(edit, ws);
  held.release();
  EXPECT_TRUE(w.grid.locks().all_free());
  EXPECT_EQ(w.grid.triangles().size(), 2u * 16 * 6);
  // The new one stands now: it can be found and taken away again, and one through it is refused.
  SurfaceGrid::Edit back;
  back.removed = {after};
  back.added = {before};
  ASSERT_EQ(w.grid.begin_edit(back, ws, held), Outcome::done);
  held.release();
  SurfaceGrid::Edit through;
  through.added = {
      {{1000, 1001, 1002}, {Vec3(9.2, 9.2, 8) * s, Vec3(9.2, 9.2, 10) * s, Vec3(9.3, 9.2, 10) * s}}};
  EXPECT_EQ(w.grid.begin_edit(through, ws, held), Outcome::self_intersection);
}

TEST(SurfaceGrid, AddedTrianglesAreTestedAgainstEachOther) {
  Workbench w(grid_mesh(4));
  const double s = w.mesh.space().scale();
  SurfaceGrid::Edit edit;
  edit.added = {
      {{1000, 1001, 1002}, {Vec3(9, 9, 9) * s, Vec3(10, 9, 9) * s, Vec3(9, 10, 9) * s}},
      {{1003, 1004, 1005}, {Vec3(9.2, 9.2, 8) * s, Vec3(9.2, 9.2, 10) * s, Vec3(9.3, 9.2, 10) * s}}};
  HeldLocks held(w.grid.locks());
  SurfaceGrid::Workspace ws;
  EXPECT_EQ(w.grid.begin_edit(edit, ws, held), Outcome::self_intersection);
}

}  // namespace
}  // namespace tetwright::surface_grid_test

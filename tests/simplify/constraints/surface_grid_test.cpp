// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/surface_grid.h"

#include "tests/simplify/workbench.h"

namespace tetwright::surface_grid_test {
namespace {

using Tag = std::optional<MaterialTag>;

TEST(SurfaceGrid, ListsBoundaryAndInterfaces) {
  Workbench w(grid_mesh({4, 4, 4}, [](int x, int, int) { return Tag(x < 2 ? 1 : 2); }));
  EXPECT_EQ(w.grid.triangles().size(), 2u * 16 * 6 + 2u * 16);
}

/// A boundary triangle of the grid, ids as in the mesh.
MeshTriangle boundary_triangle(const Workbench& w) {
  for (Index t = 0; t < w.mesh.tet_slots(); ++t) {
    if (w.mesh.dead(t)) continue;
    for (int f = 0; f < 4; ++f)
      if (w.mesh.neighbour(t, f) == no_index) {
        MeshTriangle out;
        for (int k = 0; k < 3; ++k) {
          out.ids[k] = w.mesh.points(t)[tet_faces[f][k]];
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
  // Replace it by one that pierces the whole cube.
  const double s = w.mesh.space().scale();
  edit.added = {
      {{edit.removed[0].ids, {Vec3(-1, 2.1, 2.2) * s, Vec3(5, 2.1, 2.2) * s, Vec3(5, 2.6, 2.4) * s}}, 0}};
  EXPECT_FALSE(w.grid.test(edit));
  w.expect_sound();
}

TEST(SurfaceGrid, AHarmlessTriangleReplacesAnother) {
  Workbench w(grid_mesh(4));
  SurfaceGrid::Edit edit;
  const MeshTriangle before = boundary_triangle(w);
  edit.removed = {before};
  const double s = w.mesh.space().scale();
  MeshTriangle after{before.ids, {Vec3(9, 9, 9) * s, Vec3(10, 9, 9) * s, Vec3(9, 10, 9) * s}};
  edit.added = {{after, 0}};
  ASSERT_TRUE(w.grid.test(edit));
  w.grid.take_records(edit);
  w.grid.commit(edit);
  w.grid.end_batch();
  EXPECT_EQ(w.grid.triangles().size(), 2u * 16 * 6);
  // The new triangle is in the grid now: it can be found and removed again, and one through it is refused.
  SurfaceGrid::Edit back;
  back.removed = {after};
  back.added = {{before, 0}};
  ASSERT_TRUE(w.grid.test(back));
  SurfaceGrid::Edit through;
  through.added = {
      {{{1000, 1001, 1002}, {Vec3(9.2, 9.2, 8) * s, Vec3(9.2, 9.2, 10) * s, Vec3(9.3, 9.2, 10) * s}}, 0}};
  EXPECT_FALSE(w.grid.test(through));
}

// A large triangle is in cells of a higher level than those it crosses, and the other way round.
TEST(SurfaceGrid, TrianglesOfAllSizesAreFound) {
  Workbench w(grid_mesh(6));
  const double s = w.mesh.space().scale();
  const Vec3 middle = Vec3(3, 3, 6) * s;
  for (const double size : {1e-3, 0.02, 0.3, 2.0, 40.0}) {
    const auto crosses = [&](double height) {
      SurfaceGrid::Edit edit;
      edit.removed = {boundary_triangle(w)};
      const Vec3 at = middle + Vec3(0.11, 0.07, height) * s;
      edit.added = {{{edit.removed[0].ids,
                      {at - Vec3(size, 0, size) * s, at + Vec3(size, 0.1 * size, -size) * s,
                       at + Vec3(0, 0, size) * s}},
                     0}};
      return !w.grid.test(edit);
    };
    EXPECT_TRUE(crosses(0)) << size;
    EXPECT_FALSE(crosses(1.1 * size)) << size;
  }
}

TEST(SurfaceGrid, AddedTrianglesAreTestedAgainstEachOther) {
  Workbench w(grid_mesh(4));
  const double s = w.mesh.space().scale();
  SurfaceGrid::Edit edit;
  edit.added = {
      {{{1000, 1001, 1002}, {Vec3(9, 9, 9) * s, Vec3(10, 9, 9) * s, Vec3(9, 10, 9) * s}}, 0},
      {{{1003, 1004, 1005}, {Vec3(9.2, 9.2, 8) * s, Vec3(9.2, 9.2, 10) * s, Vec3(9.3, 9.2, 10) * s}}, 0}};
  EXPECT_FALSE(w.grid.test(edit));
}

// Two edits of one batch are both tested before either is committed.
TEST(SurfaceGrid, EditsOfOneBatchAreTestedAgainstEachOther) {
  Workbench w(grid_mesh(4));
  const double s = w.mesh.space().scale();
  SurfaceGrid::Edit flat, through, beside, none;
  flat.added = {{{{1000, 1001, 1002}, {Vec3(9, 9, 9) * s, Vec3(10, 9, 9) * s, Vec3(9, 10, 9) * s}}, 0}};
  through.added = {
      {{{1003, 1004, 1005}, {Vec3(9.2, 9.2, 8) * s, Vec3(9.2, 9.2, 10) * s, Vec3(9.3, 9.2, 10) * s}}, 0}};
  // The boxes intersect, the triangles do not.
  beside.added = {
      {{{1006, 1007, 1008}, {Vec3(9.8, 9.8, 8) * s, Vec3(9.8, 9.8, 10) * s, Vec3(9.9, 9.8, 10) * s}}, 0}};
  none.removed = {boundary_triangle(w)};
  for (SurfaceGrid::Edit* e : {&flat, &through, &beside, &none}) ASSERT_TRUE(w.grid.test(*e));
  EXPECT_FALSE(SurfaceGrid::apart(flat, through));
  EXPECT_FALSE(SurfaceGrid::apart(through, flat));
  EXPECT_TRUE(SurfaceGrid::apart(flat, beside));
  EXPECT_TRUE(SurfaceGrid::apart(flat, none));
}

// A record that is given back is not reused by another edit of the same batch.
TEST(SurfaceGrid, RecordsGivenBackAreFreeAfterTheBatch) {
  Workbench w(grid_mesh(4));
  const double s = w.mesh.space().scale();
  SurfaceGrid::Edit goes, comes, later;
  goes.removed = {boundary_triangle(w)};
  comes.added = {{{{1000, 1001, 1002}, {Vec3(9, 9, 9) * s, Vec3(10, 9, 9) * s, Vec3(9, 10, 9) * s}}, 0}};
  later.added = {{{{1003, 1004, 1005}, {Vec3(9, 9, 12) * s, Vec3(10, 9, 12) * s, Vec3(9, 10, 12) * s}}, 0}};
  ASSERT_TRUE(w.grid.test(goes));
  ASSERT_TRUE(w.grid.test(comes));
  w.grid.take_records(goes);
  w.grid.take_records(comes);
  EXPECT_NE(comes.added_records.at(0), goes.removed_records.at(0));
  w.grid.commit(comes);
  w.grid.commit(goes);
  w.grid.end_batch();
  ASSERT_TRUE(w.grid.test(later));
  w.grid.take_records(later);
  EXPECT_EQ(later.added_records.at(0), goes.removed_records.at(0));
}

}  // namespace
}  // namespace tetwright::surface_grid_test

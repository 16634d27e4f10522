// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/surface_grid.h"

#include <cmath>

#include "common/random.h"
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

/// A triangle of about this size near a point.
MeshTriangle random_triangle(Random& random, const Triangle& ids, const Vec3& near, double size) {
  MeshTriangle t{ids, {}};
  for (Vec3& p : t.points)
    p = near + size * Vec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
  return t;
}

// Triangles are in cells of levels by their size: whatever the sizes, the grid finds what a test of all pairs
// finds.
TEST(SurfaceGrid, TrianglesOfAllSizesAreFound) {
  Workbench w(grid_mesh(4));
  const double s = w.mesh.space().scale();
  Random random(3);
  const auto size = [&] { return s * std::pow(10, 5 * random.uniform() - 3); };
  const auto place = [&] { return Vec3(random.uniform(), random.uniform(), random.uniform()) * 8 * s; };
  std::size_t hits = 0, misses = 0;
  for (int round = 0; round < 400; ++round) {
    // Replaces a boundary triangle, or one that was added earlier, where that intersects nothing.
    const std::vector<MeshTriangle> all = w.grid.triangles();
    const MeshTriangle removed =
        all[static_cast<std::size_t>(random.uniform() * static_cast<double>(all.size()))];
    const double own = size();
    const MeshTriangle added = random_triangle(random, removed.ids, place(), own);
    bool expected = true;
    for (const MeshTriangle& other : all)
      expected &= other.ids == removed.ids || !triangles_intersect(added, other);
    SurfaceGrid::Edit edit;
    edit.removed = {removed};
    edit.added = {{added, 0}};
    ASSERT_EQ(w.grid.test(edit), expected) << round << " " << own / s;
    ++(expected ? misses : hits);
    if (!expected) continue;
    w.grid.take_records(edit);
    w.grid.commit(edit);
    w.grid.end_batch();
  }
  EXPECT_GT(hits, 50u);
  EXPECT_GT(misses, 50u);
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

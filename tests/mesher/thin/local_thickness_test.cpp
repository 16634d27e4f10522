// SPDX-License-Identifier: Apache-2.0

// Thin walls and gaps: kept, thickened or closed as a whole, and refined within a budget.
#include "mesher/thin/local_thickness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/geometry/self_intersection.h"
#include "mesher/thin/refinement_depths.h"
#include "tests/mesher/fields.h"
#include "tetwright/error.h"
#include "tetwright/mesher.h"

namespace tetwright::local_thickness_test {
namespace {

TriangleMesh turned(TriangleMesh mesh, int turn) {
  const Eigen::AngleAxisd rotation(0.9 * turn, Vec3(1, turn, 3 - turn).normalized());
  for (Vec3& p : mesh.points) p = rotation * p;
  return mesh;
}

DenseMesh mesh_of(const TriangleMesh& surface, double cell, std::optional<int> refinement, double min_gap = 0,
                  double min_thickness = 0) {
  MesherOptions options;
  options.voxel_size = cell;
  options.max_refinement = refinement;
  options.min_gap = min_gap;
  options.min_thickness = min_thickness;
  return mesh_surfaces(make_mesher_input({{"part", 1, surface, "part.ply"}}), options, nullptr);
}

struct Counts {
  int components = 0, handles = 0;
  double volume = 0;
};
Counts counts_of(const DenseMesh& dense) {
  EXPECT_EQ(broken_promise(dense.mesh.points, dense.mesh.tets), "");
  const SolidTopology t = solid_topology(dense.mesh.points, dense.mesh.tets);
  // Without cavities all shells are boundaries of components.
  EXPECT_EQ(t.boundary_components, t.components);
  return {t.components, t.components - t.boundary_euler / 2, volume(dense.mesh.points, dense.mesh.tets)};
}

TriangleMesh plate(double thickness, int turn) {
  return turned(make_box(Vec3(0, 0, 0), Vec3(16, 16, thickness)), turn);
}
TriangleMesh boxes(double gap, int turn) {
  return turned(joined(make_box(Vec3(0, 0, 0), Vec3(5, 5, 5)), make_box(Vec3(5 + gap, 0, 0), Vec3(9, 5, 5))),
                turn);
}

TEST(ThinWalls, PlatesOfAnyThinnessStayWholeInCellsOfAnySize) {
  for (int turn = 0; turn < 3; ++turn)
    for (const double thickness : {0.02, 0.4, 1.1, 1.3, 2.0}) {
      const DenseMesh dense = mesh_of(plate(thickness, turn), 1, 0);
      const Counts found = counts_of(dense);
      EXPECT_EQ(found.components, 1) << thickness << " turned " << turn;
      EXPECT_EQ(found.handles, 0) << thickness << " turned " << turn;
      EXPECT_EQ(dense.report.refinement, 0);
      // Walls are reported exactly where they are thicker than in the input.
      if (thickness >= 1.25) {
        EXPECT_EQ(dense.report.thickened.points, 0u) << thickness;
      }
      if (thickness < 0.5) {
        EXPECT_GT(dense.report.thickened.points, 0u) << thickness;
        EXPECT_NEAR(dense.report.thickened.thickness, thickness, 0.1 * thickness + 1e-9);
      }
    }
}

TEST(ThinWalls, SmallerCellsShowTheThicknessThatThereIs) {
  for (int turn = 0; turn < 3; ++turn) {
    const DenseMesh dense = mesh_of(plate(0.4, turn), 1, std::nullopt);
    const Counts found = counts_of(dense);
    EXPECT_EQ(found.components, 1);
    EXPECT_EQ(found.handles, 0);
    EXPECT_GE(dense.report.refinement, 2);
    EXPECT_NEAR(found.volume, 16 * 16 * 0.4, 0.02 * 16 * 16 * 0.4);
    EXPECT_EQ(dense.report.thickened.points, 0u);
  }
}

TEST(ThinWalls, GapsAreKeptOrClosedWhole) {
  for (int turn = 0; turn < 3; ++turn)
    for (const double gap : {0.01, 0.3, 0.9, 1.3, 1.6})
      for (const int refinement : {0, 3}) {
        if (refinement > 0 && (gap > 0.5 || turn != 1))
          continue;  // takes long and adds nothing to the other cases
        const DenseMesh dense = mesh_of(boxes(gap, turn), 1, refinement);
        const Counts found = counts_of(dense);
        const bool shown = gap * (1 << refinement) > 1.25;
        EXPECT_EQ(found.components, shown ? 2 : 1) << gap << " turned " << turn << " refined " << refinement;
        EXPECT_EQ(found.handles, 0) << gap << " turned " << turn << " refined " << refinement;
        ASSERT_EQ(dense.report.closed_gaps.size(), shown ? 0u : 1u) << gap << " " << refinement;
        if (shown) continue;
        EXPECT_TRUE(dense.report.closed_gaps[0].gap);
        EXPECT_FALSE(dense.report.closed_gaps[0].on_purpose);
        EXPECT_NEAR(dense.report.closed_gaps[0].width, gap, 1e-6);
        EXPECT_NEAR(dense.report.closed_gaps[0].area, 25, 12);
      }
}

// Walls move back on both sides of a gap, where there are no tets that could invert.
TEST(ThinWalls, WallsThatMoveBackDoNotMeet) {
  const TriangleMesh below = make_box(Vec3(0, 0, 0), Vec3(12, 12, 0.3));
  const TriangleMesh above = make_box(Vec3(0, 0, 1.9), Vec3(12, 12, 2.2));
  TriangleMesh tilted = below;
  for (Vec3& p : tilted.points) p = Eigen::AngleAxisd(0.25, Vec3(0, 1, 0)) * p - Vec3(0, 0, 0.6);
  for (const TriangleMesh& other : {above, tilted}) {
    const DenseMesh dense = mesh_of(turned(joined(below, other), 5), 1, 0);
    counts_of(dense);
    std::vector<Triangle> faces;
    for (const InterfaceTriangle& t : dense.mesh.interfaces) faces.push_back(t.ids);
    EXPECT_TRUE(self_intersections(dense.mesh.points, faces).empty());
  }
}

TEST(ThinWalls, WhatIsNotWantedGoesOnPurpose) {
  const DenseMesh closed = mesh_of(boxes(1.6, 1), 0.5, std::nullopt, 2);
  EXPECT_EQ(counts_of(closed).components, 1);
  EXPECT_EQ(counts_of(closed).handles, 0);
  ASSERT_EQ(closed.report.closed_gaps.size(), 1u);
  EXPECT_TRUE(closed.report.closed_gaps[0].on_purpose);
  // A fin of 0.5 on a box.
  TriangleMesh fin = make_box(Vec3(0, 0, 0), Vec3(8, 8, 8));
  fin = joined(fin, make_box(Vec3(9, 0, 0), Vec3(9.5, 8, 8)));
  EXPECT_EQ(counts_of(mesh_of(fin, 0.4, std::nullopt)).components, 2);
  const DenseMesh without = mesh_of(fin, 0.4, std::nullopt, 0, 0.7);
  EXPECT_EQ(counts_of(without).components, 1);
  EXPECT_NEAR(counts_of(without).volume, 512, 6);
  ASSERT_FALSE(without.report.closed_gaps.empty());
  EXPECT_FALSE(without.report.closed_gaps[0].gap);
  EXPECT_TRUE(without.report.closed_gaps[0].on_purpose);
}

/// A U of 3 x 3 x 3 with a slot of 1 x 3 x 2 that is open above and at both ends.
TriangleMesh u_profile() {
  const std::array<std::array<double, 2>, 8> outline{
      {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}};
  TriangleMesh u;
  for (const double y : {0.0, 3.0})
    for (const auto& [x, z] : outline) u.points.emplace_back(x, y, z);
  const auto add = [&](Index a, Index b, Index c, Index d) {
    u.triangles.push_back({a, b, c});
    u.triangles.push_back({a, c, d});
  };
  for (Index k = 0; k < 8; ++k) add(k, (k + 1) % 8, (k + 1) % 8 + 8, k + 8);
  for (const auto& [a, b, c, d] : {std::array<Index, 4>{0, 5, 4, 1}, {0, 7, 6, 5}, {1, 4, 3, 2}}) {
    add(a, b, c, d);
    add(d + 8, c + 8, b + 8, a + 8);
  }
  return enclosed_volume(u) < 0 ? turned_over(u) : u;
}

TEST(ThinWalls, AClosedSlotEndsAtItsMouth) {
  ASSERT_NEAR(enclosed_volume(u_profile()), 21, 1e-12);
  for (const int turn : {0, 1}) {
    const DenseMesh dense = mesh_of(turned(u_profile(), turn), 0.1, std::nullopt, 1.2);
    const Counts found = counts_of(dense);
    EXPECT_EQ(found.components, 1);
    EXPECT_EQ(found.handles, 0);
    EXPECT_NEAR(found.volume, 27, 0.5);  // a flat lid over mouth and ends
  }
}

TEST(ThinWalls, OverlappingPartsAreNoThinWalls) {
  const TriangleMesh overlap =
      joined(make_box(Vec3(0, 0, 0), Vec3(8, 8, 8)), make_box(Vec3(7.8, 1, 1), Vec3(15, 7, 7)));
  const DenseMesh dense = mesh_of(overlap, 0.5, std::nullopt, 0, 0.4);
  EXPECT_EQ(counts_of(dense).components, 1);
  EXPECT_NEAR(counts_of(dense).volume, 512 + 7 * 36, 8);
  EXPECT_EQ(dense.report.refinement, 0);
}

TEST(ThinWalls, LimitsOutOfRangeAreRefused) {
  const TriangleMesh box = make_box(Vec3(0, 0, 0), Vec3(8, 8, 8));
  EXPECT_THROW(mesh_of(box, 0.1, std::nullopt, 3), UsageError);
  EXPECT_THROW(mesh_of(box, 0.1, std::nullopt, 0, 3), UsageError);
  EXPECT_THROW(mesh_of(box, 1, std::nullopt, -1), UsageError);
  EXPECT_THROW(mesh_of(box, 1, 9), UsageError);
}

TEST(ThinWalls, RefinementGoesWithTheThinArea) {
  std::size_t before = 0;
  for (const double size : {6.0, 12.0, 24.0}) {
    const DenseMesh dense = mesh_of(make_box(Vec3(0, 0, 0), Vec3(size, size, 0.5)), 1, std::nullopt);
    const std::size_t tets = dense.mesh.tets.size();
    if (before > 0) {
      EXPECT_GT(tets, 3 * before);
      EXPECT_LT(tets, 5 * before);
    }
    before = tets;
  }
}

TEST(ThinWalls, NothingThinTakesNothing) {
  const MesherInput input = make_input({make_box(Vec3(0, 0, 0), Vec3(8, 8, 8))});
  const GridFrame frame = make_grid_frame(input.low, input.high, 0.5, false);
  const auto level_set = LevelSet::of_surface(input.bodies[0].surface, frame, nullptr);
  const LocalThickness measured =
      measure_local_thickness(input.bodies[0].surface, *level_set, frame, {}, {}, nullptr);
  EXPECT_FALSE(measured.surface);
  EXPECT_FALSE(plan_thin_walls(measured).walls);
}

TEST(ThinWalls, WhatHasNoThicknessTakesNoMoreTetsThanItsCellsHave) {
  const auto filling = [](double thickness) {
    const MesherInput input = make_input({plate(thickness, 1)});
    const GridFrame frame = make_grid_frame(input.low, input.high, 1, false);
    const auto level_set = LevelSet::of_surface(input.bodies[0].surface, frame, nullptr);
    return plan_thin_walls(
               measure_local_thickness(input.bodies[0].surface, *level_set, frame, {}, {}, nullptr))
        .filling_tets;
  };
  const double plates_area = 16 * 16;
  EXPECT_NEAR(filling(0.5), 0.66 * plates_area / 0.25, 0.3 * 0.66 * plates_area / 0.25);
  // Eight per cell, and a slanted plate crosses fewer than three cells per squared cell.
  EXPECT_LT(filling(1e-5), 8 * 3 * plates_area);
}

LocalThickness::Region region(double added, int needed) {
  LocalThickness::Region r;
  for (int d = 0; d <= max_wall_refinement; ++d)
    r.tets[static_cast<std::size_t>(d)] =
        d == 0 ? 0 : added * std::ldexp(1, 2 * (std::min(d, needed) - needed));
  r.needed = needed;
  return r;
}

TEST(ThinWalls, TheBudgetGoesToWholeRegionsTheCheapestFirst) {
  LocalThickness measured;
  measured.regions = {region(900, 2), region(500, 3), region(100, 1), region(300, 6)};
  choose_depths({&measured}, {3, max_wall_refinement, true, 50, 1000});
  EXPECT_EQ(measured.regions[2].depth, 1);
  EXPECT_EQ(measured.regions[1].depth, 3);
  EXPECT_EQ(measured.regions[3].depth, 4);  // deeper than 3, since that adds less than 50
  EXPECT_EQ(measured.regions[0].depth, 1);  // 225 instead of 900, since nearly all of the budget is spent
  choose_depths({&measured}, {0, max_wall_refinement, false, 50, 1000});
  for (const LocalThickness::Region& r : measured.regions) EXPECT_EQ(r.depth, 0);
  choose_depths({&measured}, {3, 2, true, 50, 1e9});
  EXPECT_EQ(measured.regions[1].depth, 2);
}

TEST(ThinWalls, ADepthThatOpensNothingMoreIsNotChosen) {
  LocalThickness measured;
  measured.regions = {region(10, 3), region(10, 3), region(10, 3)};
  // A gap that opens with two halvings, one that hardly does, and a wall beside that.
  measured.regions[0].closed = {100, 98, 3, 2};
  measured.regions[1].closed = {100, 95, 90, 86};
  measured.regions[2].closed = measured.regions[1].closed;
  for (const std::size_t r : {0, 1}) measured.regions[r].has_walls = false;
  choose_depths({&measured}, {3, max_wall_refinement, false, 50, 1e9});
  EXPECT_EQ(measured.regions[0].depth, 3);
  EXPECT_EQ(measured.regions[1].depth, 0);
  EXPECT_EQ(measured.regions[2].depth, 3);
  measured.regions[1].asked = 2;
  choose_depths({&measured}, {3, max_wall_refinement, false, 50, 1e9});
  EXPECT_EQ(measured.regions[1].depth, 2);
}

TEST(ThinWalls, CellsOfTwoListsAreCombined) {
  RefinementRegions a, b;
  a.refinement = 2;
  a.cells = {{}, {7}, {1}};
  b.refinement = 1;
  b.cells = {{}, {1, 3}};
  const RefinementRegions both = combine(b, a);
  EXPECT_EQ(both.refinement, 2);
  EXPECT_EQ(both.cells, (std::vector<std::vector<MortonKey>>{{}, {7}, {1, 3}}));
  EXPECT_EQ(combine({}, {}).refinement, 0);
}

}  // namespace
}  // namespace tetwright::local_thickness_test

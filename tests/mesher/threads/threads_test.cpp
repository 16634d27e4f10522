// SPDX-License-Identifier: Apache-2.0

// Runs the parallel stages from field to cut mesh on many threads, for the thread sanitizer.
#include <gtest/gtest.h>

#include "mesher/cut/cutting.h"
#include "mesher/cut/vertex_snapping.h"
#include "mesher/labels/label_field.h"
#include "mesher/labels/label_thickness.h"
#include "mesher/level_sets/level_set_field.h"
#include "mesher/thin/field_thickness.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/resources.h"

namespace tetwright::threads_test {
namespace {

RepairedSurface ball(const Vec3& centre, double radius) {
  const TriangleMesh mesh = make_sphere(radius, centre, 4);
  RepairedSurface s;
  s.points = mesh.points;
  s.triangles = mesh.triangles;
  s.closed = s.triangles.size();
  return s;
}

CutMesh mesh_with(unsigned threads) {
  const ThreadLimit limit(threads);
  const GridFrame frame = make_grid_frame(Vec3::Constant(-1.5), Vec3::Constant(1.5), 0.08, false);
  const auto first = LevelSet::of_surface(ball(Vec3::Zero(), 1), frame, nullptr);
  const auto second = LevelSet::of_surface(ball({0.7, 0.1, 0}, 0.8), frame, nullptr);
  const LevelSetField field(frame, {first, second},
                            {{"", 0, {{0, true, 0}, {1, true, 1}}},
                             {"a", 1, {{0, false, 0}, {1, true, 1}}},
                             {"b", 2, {{1, false, 1}}}});
  const std::vector<MortonKey> interfaces = field.interface_voxels();
  find_thin_parts(field, interfaces);
  const Octree octree = build_octree(field, {false, 0.05}, interfaces,
                                     find_thin_sheets(field, interfaces).finer.cells, nullptr);
  LatticePoints points = lattice_points(octree);
  std::vector<NearestRegion> regions = lattice_regions(points, field);
  TetList tets = lattice_tets(octree, points);
  LabelledLattice lattice =
      label_lattice(std::move(points), std::move(regions), std::move(tets), 3, false, nullptr);
  read_star_values(lattice, field);
  EXPECT_GT(snap_vertices(lattice, field, nullptr).moved, 1000u);
  return cut_lattice(lattice);
}

TEST(MesherThreads, TheSameOnOneAndOnEight) {
  const CutMesh one = mesh_with(1), eight = mesh_with(8);
  EXPECT_GT(one.tets.size(), 10000u);
  EXPECT_EQ(one.points, eight.points);
  EXPECT_EQ(one.tets, eight.tets);
  EXPECT_EQ(one.regions, eight.regions);
}

TEST(LabelThreads, TheSameOnOneAndOnEight) {
  // Enough tiles for several tasks in which labels meet.
  LabelInput labels;
  labels.size = {60, 48, 48};
  labels.materials = {{"a", 1, 1, 1}, {"b", 2, 1, 1}};
  std::vector<RegionIndex> regions;
  for (int z = 0; z < 48; ++z)
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 60; ++x) regions.push_back(static_cast<RegionIndex>((x / 7 + y / 5 + z / 6) % 3));
  labels.regions = RegionGrid(labels.size);
  labels.regions.write_slices(0, regions);
  const auto keys_with = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    const GridFrame frame = label_frame(labels, 1, false);
    const auto field = LabelField::make(labels, frame, false, nullptr);
    return std::pair(field->interface_voxels(), find_thin_labels(labels, frame, nullptr).finer.cells);
  };
  EXPECT_EQ(keys_with(1), keys_with(8));
}

}  // namespace
}  // namespace tetwright::threads_test

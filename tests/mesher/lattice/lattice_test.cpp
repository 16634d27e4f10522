// SPDX-License-Identifier: Apache-2.0
#include "mesher/lattice/lattice.h"

#include <gtest/gtest.h>

#include <map>

#include "common/geometry/quality.h"
#include "tests/mesher/random_octree.h"
#include "tests/mesher/test_surfaces.h"

namespace tetwright::lattice_test {
namespace {

TEST(Lattice, FillsTheBoxWithoutTJunctions) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Octree octree = make_random_octree(seed);
    const LatticePoints points = lattice_points(octree);
    const std::vector<Tet> tets = lattice_tets(octree, points).all();
    const double box = static_cast<double>(octree.cells[0]) * octree.cells[1] * octree.cells[2];
    EXPECT_NEAR(volume(points.positions, tets), box, 1e-9 * box);

    std::map<std::array<Index, 3>, int> faces;
    double smallest = 1, flattest = 90, sharpest = 90;
    for (const Tet& t : tets) {
      const auto& p = points.positions;
      const std::array<Vec3, 4> x{p[t[0]], p[t[1]], p[t[2]], p[t[3]]};
      ASSERT_GT(tet_volume(x[0], x[1], x[2], x[3]), 0);
      smallest = std::min(smallest, min_solid_angle(x[0], x[1], x[2], x[3]));
      for (double angle : dihedral_angles(x)) {
        sharpest = std::min(sharpest, angle);
        flattest = std::max(flattest, angle);
      }
      for (const auto& f : tet_faces) {
        std::array<Index, 3> face{t[f[0]], t[f[1]], t[f[2]]};
        std::sort(face.begin(), face.end());
        ++faces[face];
      }
    }
    EXPECT_GT(smallest, 0.26);
    EXPECT_GT(sharpest, 44.99);
    EXPECT_LT(flattest, 120.01);
    for (const auto& [face, count] : faces) {
      bool on_box = false;
      for (int a = 0; a < 3; ++a)
        for (int end : {0, octree.cells[a]})
          on_box |= points.positions[face[0]][a] == end && points.positions[face[1]][a] == end &&
                    points.positions[face[2]][a] == end;
      ASSERT_EQ(count, on_box ? 1 : 2);
    }
    EXPECT_EQ(broken_promise(points.positions, tets), "");
  }
}

TEST(Lattice, EqualCells) {
  const Octree octree =
      build_octree({4, 4, 4}, 0, [](int, const std::vector<MortonKey>&) { return std::vector<MortonKey>(); });
  const LatticePoints points = lattice_points(octree);
  EXPECT_EQ(points.size(), 125u + 64u + 6u * 16u);
  ASSERT_EQ(points.leaf_centres.size(), octree.size());
  for (std::size_t i = 0; i < octree.size(); ++i) {
    const auto low = morton_decode(octree.leaf(i).key);
    EXPECT_EQ(points.positions[points.leaf_centres[i]], Vec3(low[0] + 0.5, low[1] + 0.5, low[2] + 0.5));
  }
  const std::vector<Tet> tets = lattice_tets(octree, points).all();
  EXPECT_EQ(tets.size(), 3u * 48u * 4u + 6u * 16u * 4u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points.find(points.keys[i]), i);
    EXPECT_EQ(points.find(points.keys[i], static_cast<Index>(points.size() - 1)), i);
    EXPECT_EQ(points.find(points.keys[i], 100), i);
    EXPECT_EQ(points.is_centre[i], (morton_decode(points.keys[i])[0] & 1) &&
                                       (morton_decode(points.keys[i])[1] & 1) &&
                                       (morton_decode(points.keys[i])[2] & 1));
  }
}

}  // namespace
}  // namespace tetwright::lattice_test

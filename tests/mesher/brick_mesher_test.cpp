// SPDX-License-Identifier: Apache-2.0
#include "mesher/brick_mesher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "common/random.h"
#include "mesher/field_mesher.h"
#include "tests/mesher/checked_labels.h"
#include "tests/mesher/label_volumes.h"
#include "tetwright/image_input.h"
#include "tetwright/resources.h"

namespace tetwright::brick_mesher_test {
namespace {

using Corner = std::array<double, 3>;

/// A tet by its coordinates, whose bits must agree.
struct PlainTet {
  std::array<Corner, 4> corners;
  MaterialTag material;
  auto operator<=>(const PlainTet&) const = default;
};

Corner plain(const Vec3& p) { return {p[0], p[1], p[2]}; }

void add_tets(const std::vector<Vec3>& points, const std::vector<Tet>& tets,
              const std::vector<MaterialTag>& materials, std::vector<PlainTet>& out) {
  for (std::size_t t = 0; t < tets.size(); ++t) {
    PlainTet tet;
    for (std::size_t k = 0; k < 4; ++k) tet.corners[k] = plain(points[tets[t][k]]);
    std::sort(tet.corners.begin(), tet.corners.end());
    tet.material = materials[t];
    out.push_back(tet);
  }
}

/// The tets of a brick in input units.
void add_tets(const CutMesh& mesh, const MaterialField& field, std::vector<PlainTet>& out) {
  std::vector<Vec3> points;
  for (const Vec3& p : mesh.points) points.push_back(field.frame().to_input(p));
  std::vector<MaterialTag> materials;
  for (const RegionIndex r : mesh.regions) materials.push_back(field.regions()[r].tag);
  add_tets(points, mesh.tets, materials, out);
}

std::vector<PlainTet> sorted(std::vector<PlainTet> tets) {
  std::sort(tets.begin(), tets.end());
  return tets;
}

/// Bricks of `side` finest cells that fill the frame, the first of them `first` cells long.
std::vector<CellBox> bricks_of(const GridFrame& frame, int side, const std::array<int, 3>& first) {
  std::array<std::vector<int>, 3> ends;
  for (int a = 0; a < 3; ++a) {
    ends[a].push_back(0);
    for (int at = first[a]; at < frame.cells[a]; at += side)
      if (at > 0) ends[a].push_back(at);
    ends[a].push_back(frame.cells[a]);
  }
  std::vector<CellBox> bricks;
  for (std::size_t z = 1; z < ends[2].size(); ++z)
    for (std::size_t y = 1; y < ends[1].size(); ++y)
      for (std::size_t x = 1; x < ends[0].size(); ++x)
        bricks.push_back(
            {{ends[0][x - 1], ends[1][y - 1], ends[2][z - 1]}, {ends[0][x], ends[1][y], ends[2][z]}});
  return bricks;
}

struct Tally {
  std::size_t bricks = 0, repeated = 0;
};

/// Meshes all bricks, those that are not confirmed again with twice the halo.
std::vector<BrickMesh> confirmed(const BrickMesher& mesher, const std::vector<CellBox>& boxes, Tally& tally) {
  // Small loops would wait for each other's threads.
  const ThreadLimit one(1);
  std::vector<BrickMesh> bricks(boxes.size());
  tally.bricks += bricks.size();
  std::vector<BrickBorder> borders;
  tally.repeated += make_bricks(mesher, boxes, borders, [&](const std::vector<BrickOrder>& orders) {
    for (const BrickOrder& order : orders) {
      bricks[order.brick] = mesher.mesh(boxes[order.brick], order.halo, nullptr);
      borders[order.brick] = bricks[order.brick].border;
    }
  });
  return bricks;
}

/// Meshes a volume whole and by bricks, which must give the same tets.
/// \param roots sides of bricks, root cells
Tally expect_same_tets(const LabelInput& labels, const MesherOptions& options, const std::vector<int>& roots,
                       std::uint64_t seed) {
  Tally tally;
  std::vector<PlainTet> whole;
  const TetMesh mesh = mesh_labels(labels, options, nullptr).mesh;
  add_tets(mesh.points, mesh.tets, mesh.materials, whole);
  whole = sorted(std::move(whole));
  MesherReport report;
  const BrickMesher mesher(make_volume_field(labels, options, report, nullptr), options, report, nullptr);
  const int root = 1 << mesher.frame().root_level;
  Random random(seed);
  for (const int side : roots) {
    std::array<int, 3> first;
    for (int& f : first) f = root * static_cast<int>(random.below(static_cast<std::uint32_t>(side)));
    std::vector<PlainTet> together;
    std::map<Corner, int> uses;
    std::vector<Corner> shared;
    for (const BrickMesh& made : confirmed(mesher, bricks_of(mesher.frame(), side * root, first), tally)) {
      add_tets(made.mesh, *mesher.field(), together);
      EXPECT_EQ(made.shared.size(), made.mesh.points.size());
      for (std::size_t p = 0; p < made.shared.size(); ++p) {
        ++uses[plain(made.mesh.points[p])];
        if (made.shared[p]) shared.push_back(plain(made.mesh.points[p]));
      }
    }
    EXPECT_TRUE(sorted(std::move(together)) == whole) << "bricks of " << side << " root cells";
    std::map<Corner, int> marked;
    for (const Corner& c : shared) ++marked[c];
    for (const auto& [corner, count] : uses) {
      const auto found = marked.find(corner);
      EXPECT_EQ(count > 1 ? count : 0, found == marked.end() ? 0 : found->second);
    }
  }
  return tally;
}

/// Voronoi cells of random points; one label in five is the outside.
LabelInput grains(const std::array<int, 3>& size, int count, std::uint64_t seed,
                  const Eigen::Matrix3d& directions = Eigen::Matrix3d::Identity(),
                  const Vec3& origin = Vec3::Zero()) {
  Random random(seed);
  std::vector<Vec3> centres;
  centres.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    centres.emplace_back(random.uniform() * size[0], random.uniform() * size[1], random.uniform() * size[2]);
  return make_labels(
      size,
      [&](int x, int y, int z) {
        const auto nearest =
            std::min_element(centres.begin(), centres.end(), [&](const Vec3& a, const Vec3& b) {
              return (a - Vec3(x, y, z)).squaredNorm() < (b - Vec3(x, y, z)).squaredNorm();
            });
        return static_cast<MaterialTag>((nearest - centres.begin()) % 5);
      },
      directions, origin);
}

TEST(BrickMesher, GrainsOfAVoxelASize) {
  const LabelInput labels = grains({36, 32, 30}, 28, 3);
  expect_same_tets(labels, cells_of(1), {2, 3}, 1);
}

TEST(BrickMesher, LargeCells) { expect_same_tets(grains({70, 60, 50}, 5, 5), cells_of(2.3), {2}, 2); }

TEST(BrickMesher, SmallCellsWithoutCoarseOnes) {
  expect_same_tets(grains({24, 22, 20}, 7, 7), cells_of(0.5, 0), {2, 3}, 3);
}

TEST(BrickMesher, KeptOutside) {
  MesherOptions options = cells_of(1);
  options.keep_outside = true;
  expect_same_tets(grains({34, 30, 28}, 20, 9), options, {2}, 4);
}

TEST(BrickMesher, ObliqueAndMirroredAxes) {
  Eigen::Matrix3d directions;
  directions << 0.8, 0.1, 0, 0, 1.1, 0.2, 0.1, 0, -1.7;
  const LabelInput labels = grains({36, 30, 20}, 16, 11, directions, Vec3(1000.1, -3, 77));
  expect_same_tets(labels, cells_of(0.9), {2}, 5);
}

/// Layers of one to three voxels, whose cells are halved, with holes and rods.
TEST(BrickMesher, ThinLayers) {
  const LabelInput labels = make_labels({30, 28, 26}, [](int x, int y, int z) {
    if (length(x - 15, y - 14, 0) < 4) return 7;
    const int layer = (z + x / 9) % 9;
    return layer < 1 ? 1 : layer < 3 ? 2 : layer < 6 ? 0 : 3;
  });
  // Moves reach farther than the usual halo.
  EXPECT_GT(expect_same_tets(labels, cells_of(1), {2}, 6).repeated, 0U);
}

TEST(BrickMesher, Images) {
  ImageVolume image;
  image.size = {40, 34, 30};
  std::vector<float>& values = image.channels.emplace_back();
  for (int z = 0; z < image.size[2]; ++z)
    for (int y = 0; y < image.size[1]; ++y)
      for (int x = 0; x < image.size[0]; ++x)
        values.push_back(static_cast<float>(std::sin(0.4 * x) * std::cos(0.4 * y) +
                                            std::sin(0.4 * y) * std::cos(0.4 * z) +
                                            std::sin(0.4 * z) * std::cos(0.4 * x)));
  ImageChoice choice;
  choice.isos = {{"low", -0.3}, {"high", 0.4}};
  expect_same_tets(make_image_input(std::move(image), "image", choice, nullptr, nullptr), cells_of(1), {2, 3},
                   7);
}

TEST(BrickMesher, SameBytesForAnySideOfBricks) {
  const LabelInput labels = make_labels({50, 46, 41}, [](int x, int y, int z) {
    if (length(x - 20, y - 20, z - 20) < 14) return length(x - 22, y - 20, z - 18) < 9 ? 2 : 1;
    return z < 3 ? 4 : length(x - 40, y - 30, 0) < 2 ? 5 : 0;
  });
  const DenseMesh whole = mesh_labels(labels, cells_of(1), nullptr);
  MesherReport report;
  const BrickMesher mesher(make_volume_field(labels, cells_of(1), report, nullptr), cells_of(1), report,
                           nullptr);
  for (const int side : {16, 32, 64}) {
    MesherReport counts;
    BrickedMesh made = mesher.mesh_all(side << report.refinement, counts, nullptr);
    EXPECT_GT(made.bricks, side < 64 ? 1U : 0U);
    EXPECT_EQ(counts.cells, whole.report.cells);
    EXPECT_EQ(counts.lattice_tets, whole.report.lattice_tets);
    EXPECT_EQ(counts.isolated_vertices, whole.report.isolated_vertices);
    DenseMesh dense;
    set_mesh(std::move(made.mesh), mesher.field(), dense);
    EXPECT_TRUE(dense.mesh.points == whole.mesh.points) << side;
    EXPECT_TRUE(dense.mesh.tets == whole.mesh.tets) << side;
    EXPECT_TRUE(dense.mesh.materials == whole.mesh.materials) << side;
    EXPECT_TRUE(dense.mesh.interfaces == whole.mesh.interfaces) << side;
  }
}

TEST(BrickMesher, BricksOfDifferentHistoriesAreNotConfirmed) {
  std::vector<BrickBorder> bricks(3);
  std::vector<const BrickBorder*> borders;
  for (int b = 0; b < 3; ++b) {
    BrickBorder& border = bricks[static_cast<std::size_t>(b)];
    border.brick = {{8 * b, 0, 0}, {8 * b + 8, 8, 8}};
    borders.push_back(&border);
  }
  const MortonKey in_second = morton_encode(20, 4, 4), at_border = morton_encode(16, 4, 4);
  bricks[1].seam.offered = {{in_second, 7}};
  const auto unconfirmed = [&](std::vector<SeamPoint> needed) {
    bricks[0].seam.needed = std::move(needed);
    return unconfirmed_bricks(borders);
  };
  using Numbers = std::vector<std::size_t>;
  EXPECT_EQ(unconfirmed({}), Numbers());
  EXPECT_EQ(unconfirmed({{in_second, 7}}), Numbers());
  EXPECT_EQ(unconfirmed({{in_second, 8}}), (Numbers{0, 1}));
  // A point that is near an interface in one of the bricks only.
  EXPECT_EQ(unconfirmed({{in_second, SeamPoint::not_near}}), (Numbers{0, 1}));
  EXPECT_EQ(unconfirmed({{at_border, 7}}), (Numbers{0, 1}));
  EXPECT_EQ(unconfirmed({{at_border, SeamPoint::not_near}}), Numbers());
}

}  // namespace
}  // namespace tetwright::brick_mesher_test

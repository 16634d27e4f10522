// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/random.h"
#include "tests/mesher/checked_labels.h"
#include "tests/mesher/label_volumes.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"

namespace tetwright::label_mesher_test {
namespace {

/// Checks the guarantees for cells no larger than half a voxel.
void expect_faithful(const LabelInput& labels, const TetMesh& mesh) {
  const LabelComparison f = compare_with_voxels(labels, mesh);
  EXPECT_EQ(f.lost, 0u) << comparison_line(f);
  EXPECT_LE(f.moved, 0.75) << comparison_line(f);
  EXPECT_LE(f.worst_volume, 0.02) << comparison_line(f);
}

struct Angles {
  double percent_bad = 0, smallest = HUGE_VAL;
};
Angles angles_of(const TetMesh& mesh) {
  Angles a;
  std::size_t bad = 0;
  for (const auto& [i, j, k, l] : mesh.tets) {
    const double angle = min_solid_angle(mesh.points[i], mesh.points[j], mesh.points[k], mesh.points[l]);
    bad += angle < 0.1;
    a.smallest = std::min(a.smallest, angle);
  }
  a.percent_bad = 100.0 * static_cast<double>(bad) / static_cast<double>(mesh.tets.size());
  return a;
}

/// Voronoi cells of scattered seeds: blobs mostly without thin parts, of labels from `lowest` on.
LabelInput blobs(const std::array<int, 3>& size, int seeds, int labels, std::uint64_t seed,
                 MaterialTag lowest = 1, const Eigen::Matrix3d& directions = Eigen::Matrix3d::Identity(),
                 const Vec3& origin = Vec3::Zero()) {
  Random random(seed);
  struct Seed {
    Vec3 at;
    MaterialTag label;
  };
  std::vector<Seed> all;
  for (int i = 0; i < seeds; ++i)
    all.push_back({Vec3(random.uniform() * size[0], random.uniform() * size[1], random.uniform() * size[2]),
                   static_cast<MaterialTag>(lowest + i % labels)});
  return make_labels(
      size,
      [&](int x, int y, int z) {
        double min_distance = HUGE_VAL;
        MaterialTag label = 0;
        for (const Seed& s : all) {
          const double d = (s.at - Vec3(x, y, z)).squaredNorm();
          if (d < min_distance) min_distance = d, label = s.label;
        }
        return label;
      },
      directions, origin);
}

TEST(LabelMesher, CentresInterfacesAndVolumesOfBlobs) {
  const LabelInput labels = blobs({14, 13, 12}, 6, 3, 11);
  MesherOptions uniform = cells_of(0.5), with_outside = cells_of(0.5);
  uniform.uniform = true;
  with_outside.keep_outside = true;
  for (const MesherOptions& options : {cells_of(0.5), cells_of(0.37), uniform, with_outside})
    expect_faithful(labels, checked_mesh(labels, options).mesh);
}

TEST(LabelMesher, CentresOfBlobsAndGapsBetweenThem) {
  const LabelInput labels = blobs({14, 13, 12}, 6, 3, 11, 0);
  for (const double cell : {0.5, 0.37}) expect_faithful(labels, checked_mesh(labels, cell).mesh);
}

TEST(LabelMesher, CentresInterfacesAndVolumesOfBallsTouchingOneAnother) {
  const LabelInput labels = make_labels({26, 16, 16}, [](int x, int y, int z) {
    if (length(x - 7.3, y - 7.6, z - 7.4) < 6.5) return 3;
    return length(x - 17.7, y - 7.2, z - 7.9) < 6.5 ? 9 : 0;
  });
  for (const LabelMaterial& m : labels.materials) EXPECT_GT(m.voxels, LabelComparison::many_voxels);
  for (const double cell : {0.5, 0.3}) expect_faithful(labels, checked_mesh(labels, cell).mesh);
}

LabelInput noise(int side, std::uint32_t labels, std::uint64_t seed) {
  Random random(seed);
  return make_labels({side, side, side},
                     [&](int, int, int) { return static_cast<MaterialTag>(random.below(labels)); });
}

TEST(LabelMesher, InterfacesOfNoiseStayNear) {
  for (const std::uint32_t labels : {2u, 6u}) {
    const LabelInput volume = noise(4, labels, labels);
    const LabelComparison f = compare_with_voxels(volume, checked_mesh(volume, 0.5).mesh);
    EXPECT_LE(f.moved, 0.75) << comparison_line(f);
  }
}

TEST(LabelMesher, CentresOfNoise) {
  std::size_t lost = 0, centres = 0;
  for (std::uint64_t seed = 1; seed < 5; ++seed) {
    const LabelInput volume = noise(4, 2 + seed % 2, seed);
    const LabelComparison f = compare_with_voxels(volume, checked_mesh(volume, 0.5).mesh);
    lost += f.lost;
    centres += f.centres;
  }
  EXPECT_EQ(lost, 0u) << "of " << centres;
}

struct Sides {
  MaterialTag below, above;
};
const std::vector<Sides> all_sides{{0, 0}, {1, 1}, {1, 3}, {0, 1}};

const std::string shell = "components 1, euler 2, boundary components 2, boundary euler 4";

/// Expects that the sheet, label 2, has this topology.
void expect_whole(const LabelInput& labels, double adaptivity, const std::string& topology) {
  const TetMesh mesh = checked_mesh(labels, cells_of(0.5, adaptivity)).mesh;
  expect_line(mesh, (labels.materials.size() > 1 ? "material 2: " : "domain: ") + topology);
}

/// Expects that a plane across a volume, given by its slopes, stays whole.
void expect_plane_whole(double a, double b, double thickness, double adaptivity) {
  for (const Sides& s : all_sides) {
    SCOPED_TRACE(::testing::Message()
                 << "slopes " << a << " " << b << ", " << s.below << " below, " << s.above);
    expect_whole(make_labels({9, 8, 12},
                             [&](int x, int y, int z) {
                               const double d = z - 5.537 - a * (x - 4) - b * (y - 4);
                               return d < 0 ? s.below : d < thickness ? 2 : s.above;
                             }),
                 adaptivity, disc);
  }
}
void expect_shells_whole(double adaptivity, const std::vector<Sides>& sides) {
  for (const Sides& s : sides) {
    SCOPED_TRACE(::testing::Message() << s.below << " within, " << s.above);
    expect_whole(make_labels({9, 10, 8},
                             [&](int x, int y, int z) {
                               const int depth = std::min({x - 1, 7 - x, y - 1, 8 - y, z - 1, 6 - z});
                               return depth > 0 ? s.below : depth == 0 ? 2 : s.above;
                             }),
                 adaptivity, shell);
    for (const double radius : {3.0, 4.3})
      expect_whole(make_labels({12, 12, 12},
                               [&](int x, int y, int z) {
                                 const double d = length(x - 5.6, y - 5.3, z - 5.5) - radius;
                                 return std::abs(d) <= 0.5 ? 2 : d < 0 ? s.below : s.above;
                               }),
                   adaptivity, shell);
  }
}

TEST(LabelMesher, SheetsOfAVoxelStayWholeInFinestCells) {
  expect_plane_whole(0.5, 0.31, 1.81, 0);
  expect_plane_whole(0.7, 0.7, 2.4, 0);
  expect_plane_whole(0.93, 0.4, 1, 0);
  expect_plane_whole(1.0, 0.0, 1, 0);
  expect_shells_whole(0, {{1, 3}, {0, 1}});
}

TEST(LabelMesher, EdgeConnectedPlanesOfAVoxelStayWhole) {
  for (const auto& [a, b] : {std::pair(0.2, 0.1), {0.93, 0.4}, {1.0, 0.0}, {0.5, 0.5}})
    expect_plane_whole(a, b, 1, MesherOptions().adaptivity);
}

TEST(LabelMesher, FaceConnectedPlanesOfAVoxelStayWhole) {
  for (const auto& [a, b] : {std::pair(0.0, 0.0), {0.2, 0.1}, {0.5, 0.31}, {0.7, 0.7}})
    expect_plane_whole(a, b, 1 + a + b, MesherOptions().adaptivity);
}

TEST(LabelMesher, ShellsOfAVoxelStayWhole) { expect_shells_whole(MesherOptions().adaptivity, all_sides); }

TEST(LabelMesher, VolumesOfSheetsOfAVoxel) {
  for (const Sides& sides : {Sides{1, 1}, {0, 1}}) {
    SCOPED_TRACE(::testing::Message() << sides.below << " within, " << sides.above);
    const LabelInput labels = make_labels({26, 26, 26}, [&](int x, int y, int z) {
      const double r = length(x - 12.5, y - 12.5, z - 12.5);
      return r > 11 ? 0 : r > 10 ? sides.above : r > 9 ? 2 : sides.below;
    });
    EXPECT_GT(labels.materials.back().voxels, LabelComparison::many_voxels);
    expect_faithful(labels, checked_mesh(labels, 0.5).mesh);
  }
}

double normals_rms_degrees(const TetMesh& mesh, const Vec3& centre) {
  double sum = 0, area = 0;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    const Vec3 &a = mesh.points[t.ids[0]], &b = mesh.points[t.ids[1]], &c = mesh.points[t.ids[2]];
    const Vec3 normal = (b - a).cross(c - a);
    const double cosine = normal.normalized().dot(((a + b + c) / 3 - centre).normalized());
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
    sum += normal.norm() * angle * angle;
    area += normal.norm();
  }
  return std::sqrt(sum / area);
}

TEST(LabelMesher, NormalsOfABallAreSmooth) {
  for (const Vec3& centre : {Vec3(11, 11, 11), Vec3(11.3, 11.1, 11.45)}) {
    const LabelInput labels = make_labels(
        {24, 24, 24}, [&](int x, int y, int z) { return (Vec3(x, y, z) - centre).norm() <= 10 ? 1 : 0; });
    for (const double cell : {1.0, 0.5}) {
      const double rms = normals_rms_degrees(checked_mesh(labels, cell).mesh, centre);
      EXPECT_LT(rms, 10) << cell;
    }
  }
}

/// True if each voxel is in a cube of 2 x 2 x 2 of its label; the outside continues beyond the volume.
bool two_thick(const LabelInput& labels) {
  const auto at = [&](int x, int y, int z) {
    const std::array<int, 3> v{x, y, z};
    for (int a = 0; a < 3; ++a)
      if (v[a] < 0 || v[a] >= labels.size[a]) return outside_region;
    return labels.regions[(static_cast<std::size_t>(z) * labels.size[1] + y) * labels.size[0] + x];
  };
  for (int z = 0; z < labels.size[2]; ++z)
    for (int y = 0; y < labels.size[1]; ++y)
      for (int x = 0; x < labels.size[0]; ++x) {
        bool thick = false;
        for (int k = 0; k < 8 && !thick; ++k) {
          thick = true;
          for (int c = 0; c < 8; ++c)
            thick &= at(x - (k & 1) + (c & 1), y - (k >> 1 & 1) + (c >> 1 & 1), z - (k >> 2) + (c >> 2)) ==
                     at(x, y, z);
        }
        if (!thick) return false;
      }
  return true;
}

/// Random labels on coarse voxels of 2 x 2 x 2.
LabelInput doubled_noise(int side, std::uint32_t labels, std::uint64_t seed) {
  Random random(seed);
  std::vector<MaterialTag> coarse;
  for (int i = 0; i < side * side * side; ++i)
    coarse.push_back(static_cast<MaterialTag>(random.below(labels)));
  return make_labels({2 * side, 2 * side, 2 * side},
                     [&](int x, int y, int z) { return coarse[((z / 2) * side + y / 2) * side + x / 2]; });
}

void expect_good_shapes(const LabelInput& labels, double cell = 1, double max_bad = 2) {
  const Angles a = angles_of(checked_mesh(labels, cell).mesh);
  EXPECT_LE(a.percent_bad, max_bad);
  EXPECT_GE(a.smallest, 0.001);
}

TEST(LabelMesher, ShapesOfTetsInCellsOfAVoxel) {
  const LabelInput ball = make_labels(
      {24, 24, 24}, [](int x, int y, int z) { return length(x - 11.3, y - 11.1, z - 11.4) < 10 ? 1 : 0; });
  const LabelInput cube = make_labels({12, 12, 12}, [](int x, int y, int z) {
    return x < 2 || y < 2 || z < 2 || x > 9 || y > 9 || z > 9 ? 0 : x < 6 ? 1 : z < 6 ? 2 : 3;
  });
  const LabelInput slabs = make_labels({12, 12, 12}, [](int x, int, int) { return 1 + x / 2 % 2; });
  for (const LabelInput* labels : {&cube, &slabs}) EXPECT_TRUE(two_thick(*labels));
  for (const LabelInput* labels : {&ball, &cube, &slabs}) expect_good_shapes(*labels);
}

// Parts are two voxels thick here as well, but four labels meet along every line between them, so more tets
// are bad.
TEST(LabelMesher, ShapesOfTetsWhereManyLabelsMeet) {
  const LabelInput bars =
      make_labels({12, 12, 12}, [](int x, int, int z) { return x / 2 % 2 + 2 * (z / 4 % 2); });
  for (const LabelInput& labels : {bars, doubled_noise(6, 2, 2), doubled_noise(6, 5, 5)}) {
    EXPECT_TRUE(two_thick(labels));
    expect_good_shapes(labels, 1, 40);
  }
}

// In cells of half a voxel lattice points lie on the plane between the labels.
TEST(LabelMesher, ShapesOfTetsWhereAPlaneBetweenLabelsEnds) {
  const LabelInput three = make_labels({12, 12, 12}, [](int x, int, int z) {
    return x < 6 ? 1 : z < 6 ? 2 : 3;
  });
  for (const double cell : {1.0, 0.5}) expect_good_shapes(three, cell, 10);
}

struct Directions {
  const char* what;
  Eigen::Matrix3d matrix;
};

std::vector<Directions> all_directions() {
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized()) * Eigen::AngleAxisd(1.1, Vec3::UnitZ())).matrix();
  Eigen::Matrix3d shear = Eigen::Matrix3d::Identity(), swap = Eigen::Matrix3d::Zero();
  shear(0, 1) = 0.3, shear(0, 2) = -0.2, shear(1, 2) = 0.25;
  swap(1, 0) = swap(0, 1) = swap(2, 2) = 1;
  const auto scaled = [](double x, double y, double z) {
    return Eigen::Matrix3d(Vec3(x, y, z).asDiagonal());
  };
  return {{"anisotropic", scaled(0.7, 0.8, 1.5)},
          {"flat voxels", scaled(0.5, 0.5, 2.5)},
          {"turned", turn},
          {"turned, anisotropic", turn * scaled(0.6, 1, 1.3)},
          {"mirrored", scaled(-1, 1, 1)},
          {"mirrored along z", scaled(1, 1, -0.8)},
          {"axes swapped", swap},
          {"left-posterior", scaled(-0.9, -0.9, 2)},
          {"turned, mirrored", turn * scaled(1, -0.7, 1)},
          {"sheared", shear},
          {"turned, sheared, mirrored", turn * shear * scaled(1, 1, -1)},
          {"large", scaled(1e6, 1e6, 2e6)},
          {"small", scaled(1e-6, 1e-6, 1e-6)}};
}

TEST(LabelMesher, RightPlacesInAnyDirections) {
  for (const Directions& d : all_directions()) {
    SCOPED_TRACE(d.what);
    const double voxel = d.matrix.colwise().norm().minCoeff();
    const LabelInput labels = blobs({8, 7, 9}, 5, 3, 5, 1, d.matrix, voxel * Vec3(100, -50, 7));
    const DenseMesh meshed = checked_mesh(labels, 0.5 * voxel);
    for (const auto& [a, b, c, e] : meshed.mesh.tets)
      EXPECT_GT(tet_volume(meshed.mesh.points[a], meshed.mesh.points[b], meshed.mesh.points[c],
                           meshed.mesh.points[e]),
                0);
    expect_faithful(labels, meshed.mesh);
    EXPECT_GE(angles_of(meshed.mesh).smallest, 0.001);
  }
}

// A label that fills the volume ends at the border of the outermost voxels, half a voxel beyond their
// centres.
TEST(LabelMesher, LabelsTouchingTheBorder) {
  const LabelInput full = make_labels({9, 8, 7}, [](int, int, int) { return 4; });
  const TetMesh mesh = checked_mesh(full, 0.5).mesh;
  expect_faithful(full, mesh);
  expect_line(mesh, "domain: " + disc);
  Vec3 low = mesh.points[0], high = low;
  for (const Vec3& p : mesh.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  EXPECT_LT((low - Vec3(-0.5, -0.5, -0.5)).cwiseAbs().maxCoeff(), 0.25) << low.transpose();
  EXPECT_LT((high - Vec3(8.5, 7.5, 6.5)).cwiseAbs().maxCoeff(), 0.25) << high.transpose();
  MesherOptions with_outside = cells_of(0.5);
  with_outside.keep_outside = true;
  expect_faithful(full, checked_mesh(full, with_outside).mesh);

  const LabelInput layers =
      make_labels({12, 12, 12}, [](int x, int, int z) { return 1 + x / 6 + 2 * (z / 6); });
  expect_faithful(layers, checked_mesh(layers, 0.5).mesh);
}

using Size = std::array<int, 3>;

void expect_volume_of_one_label(const Size& size, double cell) {
  SCOPED_TRACE(::testing::Message() << size[0] << " x " << size[1] << " x " << size[2] << ", cell " << cell);
  const LabelInput labels = make_labels(size, [](int, int, int) { return 1; });
  MesherOptions with_outside = cells_of(cell);
  with_outside.keep_outside = true;
  try {
    const TetMesh mesh = checked_mesh(labels, cell).mesh;
    const LabelComparison f = compare_with_voxels(labels, mesh);
    EXPECT_EQ(f.lost + f.lone_lost, 0u);
    EXPECT_LE(f.moved, 0.75);
    expect_line(mesh, "domain: " + disc);
    checked_mesh(labels, with_outside);
  } catch (const std::exception& e) {
    ADD_FAILURE() << e.what();
  }
}

TEST(LabelMesher, TinyVolumes) {
  for (const double cell : {1.0, 0.5})
    for (const Size& size : {Size{2, 2, 2}, Size{1, 5, 4}, Size{6, 1, 3}, Size{4, 7, 1}, Size{3, 3, 3}})
      expect_volume_of_one_label(size, cell);
  for (const Size& size : {Size{1, 1, 1}, Size{2, 1, 1}, Size{1, 1, 9}})
    expect_volume_of_one_label(size, 0.25);
}

TEST(LabelMesher, RowsOfVoxels) {
  for (const Size& size : {Size{1, 1, 1}, Size{2, 1, 1}, Size{1, 1, 9}})
    expect_volume_of_one_label(size, 0.5);
}

TEST(LabelMesher, NoiseOfManyLabelsStaysValid) {
  for (const std::uint32_t labels : {2u, 20u})
    EXPECT_GE(angles_of(checked_mesh(noise(5, labels, labels), 1).mesh).smallest, 0.001) << labels;
}

TEST(LabelMesher, TheSameBytesForAnyNumberOfThreads) {
  const LabelInput labels = blobs({20, 18, 19}, 12, 5, 3);
  const auto mesh_with = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return mesh_labels(labels, cells_of(1), nullptr).mesh;
  };
  const TetMesh one = mesh_with(1);
  for (const unsigned threads : {2u, 5u}) {
    const TetMesh many = mesh_with(threads);
    EXPECT_EQ(one.points, many.points);
    EXPECT_EQ(one.tets, many.tets);
    EXPECT_EQ(one.materials, many.materials);
    EXPECT_EQ(one.interfaces, many.interfaces);
  }
}

TEST(LabelMesher, CoarseCellsWithoutThinParts) {
  const Vec3 centre(19.6, 20.3, 19.9);
  const LabelInput labels = make_labels({40, 40, 40}, [&](int x, int y, int z) {
    return (Vec3(x, y, z) - centre).norm() > 18 ? 0 : x < 20 ? 1 : 2;
  });
  for (const double cell : {2.0, 3.0, 5.0}) {
    SCOPED_TRACE(cell);
    const DenseMesh m = checked_mesh(labels, cell);
    const LabelComparison f = compare_with_voxels(labels, m.mesh);
    EXPECT_LE(f.moved, 0.5 * cell) << comparison_line(f);
    EXPECT_LE(f.worst_volume, 0.02 * cell) << comparison_line(f);
    expect_line(m.mesh, "material 1: " + disc);
    expect_line(m.mesh, "material 2: " + disc);
  }
}

TEST(LabelMesher, CoarseCellsKeepThinSheets) {
  for (const int thickness : {1, 2})
    for (const double cell : {2.0, 5.0}) {
      SCOPED_TRACE(::testing::Message() << "sheet of " << thickness << ", cell " << cell);
      const LabelInput labels = make_labels({18, 17, 20}, [&](int, int, int z) {
        return z < 9 ? 1 : z < 9 + thickness ? 2 : 3;
      });
      const DenseMesh m = checked_mesh(labels, cell);
      const LabelComparison f = compare_with_voxels(labels, m.mesh);
      expect_line(m.mesh, "material 2: " + disc);
      EXPECT_LE(f.moved, 0.5 * cell) << comparison_line(f);
    }
}

TEST(LabelMesher, CoarseCellsKeepShells) {
  for (const double cell : {1.0, 2.0, 3.0}) {
    SCOPED_TRACE(cell);
    const LabelInput labels = make_labels({22, 22, 22}, [&](int x, int y, int z) {
      const double d = length(x - 10.6, y - 10.3, z - 10.5) - 8;
      return d > 0 ? 0 : d > -1.6 ? 2 : 1;
    });
    const DenseMesh m = checked_mesh(labels, cell);
    const LabelComparison f = compare_with_voxels(labels, m.mesh);
    expect_line(m.mesh, "material 2: " + shell);
    EXPECT_LE(f.moved, 0.5 * cell + 0.25) << comparison_line(f);
  }
}

}  // namespace
}  // namespace tetwright::label_mesher_test

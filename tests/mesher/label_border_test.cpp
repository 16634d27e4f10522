// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include "tests/mesher/checked_labels.h"
#include "tests/mesher/label_volumes.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::label_border_test {
namespace {

/// Checks that the boundary near the volume's border lies exactly on it, with the patch of its side, and that
/// its area on each side is that of the labels.
/// \param tolerance relative
/// \return the number of faces on the border
std::size_t expect_cut_off(const LabelInput& labels, const TetMesh& mesh, double tolerance) {
  const Eigen::Matrix3d to_index = labels.directions.inverse();
  const bool mirrored = labels.directions.determinant() < 0;
  std::array<double, 7> areas{};
  std::size_t count = 0;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    std::array<Vec3, 3> at;
    for (int k = 0; k < 3; ++k) at[k] = to_index * (mesh.points[t.ids[k]] - labels.origin);
    const Vec3 normal = (at[1] - at[0]).cross(at[2] - at[0]);
    std::uint16_t patch = 0;
    for (int a = 0; a < 3; ++a)
      for (int side = 0; side < 2; ++side) {
        const double border = side == 0 ? -0.5 : labels.size[a] - 0.5;
        double nearest = HUGE_VAL, farthest = 0;
        for (const Vec3& p : at) {
          nearest = std::min(nearest, std::abs(p[a] - border));
          farthest = std::max(farthest, std::abs(p[a] - border));
          EXPECT_LE((2 * side - 1) * (p[a] - border), 1e-9);
        }
        if (farthest < 1e-9) {
          patch = static_cast<std::uint16_t>(1 + 2 * a + (mirrored && a == 2 ? 1 - side : side));
        } else if (!t.other && farthest < 0.3) {
          // Rounded rims would appear as faces along the border, but off it.
          EXPECT_LT(std::abs(normal.normalized()[a]), 0.9) << at[0].transpose() << ", " << nearest;
        }
      }
    EXPECT_EQ(t.patch, patch) << at[0].transpose();
    if (patch == 0) continue;
    ++count;
    areas[patch] += normal.norm() / 2;
  }
  std::array<double, 7> faces{};
  std::size_t i = 0;
  for (int z = 0; z < labels.size[2]; ++z)
    for (int y = 0; y < labels.size[1]; ++y)
      for (int x = 0; x < labels.size[0]; ++x, ++i)
        for (int a = 0; a < 3 && labels.regions[i] != outside_region; ++a)
          for (int side = 0; side < 2; ++side)
            faces[1 + 2 * a + (mirrored && a == 2 ? 1 - side : side)] +=
                std::array{x, y, z}[a] == (side == 0 ? 0 : labels.size[a] - 1);
  for (int patch = 1; patch <= 6; ++patch)
    EXPECT_NEAR(areas[patch], faces[patch], tolerance * faces[patch]) << patch;
  return count;
}

/// Directions of rotated, mirrored and skewed volumes.
std::vector<Eigen::Matrix3d> several_directions() {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) * Eigen::Matrix3d(Vec3(1, 1, 1.3).asDiagonal());
  Eigen::Matrix3d tilted = Eigen::Matrix3d::Identity();
  tilted(1, 2) = 0.2;
  return {Eigen::Matrix3d::Identity(), turn, Eigen::Matrix3d(Vec3(1, -1, 1).asDiagonal()), tilted};
}

TEST(LabelBorder, AFullVolumeIsItsBox) {
  for (const Eigen::Matrix3d& directions : several_directions())
    for (const double cell : {0.5, 1.0, 2.3}) {
      const LabelInput labels = make_labels(
          {7, 6, 9}, [](int, int, int) { return 4; }, directions, Vec3(1, 2, 3));
      const DenseMesh meshed = checked_mesh(labels, cell);
      expect_cut_off(labels, meshed.mesh, 1e-9);
      const double volume = 7 * 6 * 9 * std::abs(directions.determinant());
      double filled = 0;
      for (const auto& [a, b, c, d] : meshed.mesh.tets)
        filled += tet_volume(meshed.mesh.points[a], meshed.mesh.points[b], meshed.mesh.points[c],
                             meshed.mesh.points[d]);
      EXPECT_NEAR(filled, volume, 1e-9 * volume);
      expect_line(meshed.mesh, "domain: " + disc);
      EXPECT_EQ(meshed.report.creases.segments.size(), 12u);
      EXPECT_EQ(meshed.report.creases.corners.size(), 8u);
    }
}

TEST(LabelBorder, SidesHaveNames) {
  // The names of all faces on the border, each checked to be on the side of that name.
  const auto names_of = [](const LabelInput& labels) {
    const DenseMesh meshed = checked_mesh(labels, 1);
    Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
    for (const Vec3& p : meshed.mesh.points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    std::set<std::string> names;
    for (const InterfaceTriangle& t : meshed.mesh.interfaces) {
      const auto group = meshed.mesh.patch_groups.find({t.pair(), t.patch});
      EXPECT_EQ(group != meshed.mesh.patch_groups.end(), t.patch != 0);
      if (t.patch == 0) continue;
      const std::string& name = group->second.name;
      names.insert(name);
      const std::string side = name.substr(name.find("border_") + 7);
      const int axis = side[0] - 'x';
      for (const Index p : t.ids)
        EXPECT_NEAR(meshed.mesh.points[p][axis], (side.ends_with("min") ? low : high)[axis], 1e-9) << name;
    }
    return names;
  };
  const std::set<std::string> all{"border_x_max", "border_x_min", "border_y_max",
                                  "border_y_min", "border_z_max", "border_z_min"};
  // The axes of the second volume are z, -x and -y.
  Eigen::Matrix3d turned;
  turned << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  for (const Eigen::Matrix3d& directions : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), turned})
    EXPECT_EQ(names_of(make_labels(
                  {7, 6, 9}, [](int, int, int) { return 4; }, directions, Vec3(1, 2, 3))),
              all);
  const LabelInput two = make_labels({8, 8, 8}, [](int x, int y, int) {
    return y < 2 || y > 5 ? 0 : x < 4 ? 1 : 2;
  });
  EXPECT_EQ(names_of(two),
            (std::set<std::string>{"border_x_min", "border_x_max", "label_1:border_z_min",
                                   "label_2:border_z_min", "label_1:border_z_max", "label_2:border_z_max"}));
}

TEST(LabelBorder, CellsOfAThinVolumeAreNotFlat) {
  const LabelInput labels = make_labels({12, 12, 1}, [](int x, int, int) { return x < 5 ? 1 : 2; });
  for (const double cell : {4.0, 6.0}) {
    const DenseMesh meshed = checked_mesh(labels, cell);
    EXPECT_LE(meshed.report.cell_size, 1.5);
    EXPECT_EQ(mesh_statistics(meshed.mesh, 0.1).below_count, 0u);
  }
}

TEST(LabelBorder, LabelsAreCutOffByPlanes) {
  for (const Eigen::Matrix3d& directions : several_directions())
    for (const double cell : {0.5, 1.0}) {
      // A ball cut off by one side, and two labels in a corner of the box that meet on its sides and edge.
      const LabelInput labels = make_labels(
          {22, 20, 18},
          [](int x, int y, int z) {
            if (length(x - 17, y - 11.3, z - 9) < 6.3) return 1;
            return length(x + 0.5, y + 0.5, z + 0.5) < 10.2 ? (x + y < 2 * z ? 2 : 3) : 0;
          },
          directions, Vec3(-3, 2, 5));
      const DenseMesh meshed = checked_mesh(labels, cell);
      EXPECT_GT(expect_cut_off(labels, meshed.mesh, 0.04), 300u);
      for (const auto& [tag, ratio] : compare_with_voxels(labels, meshed.mesh).volumes)
        EXPECT_NEAR(ratio, 1, 0.016) << tag;  // whole cells at the sides round off their corners
      for (const MaterialTag tag : {1, 2, 3})
        expect_line(meshed.mesh, "material " + std::to_string(tag) + ": " + disc);
      // Along the edges of the box from its corner.
      EXPECT_EQ(meshed.report.creases.corners.size(), 1u);
      EXPECT_GE(meshed.report.creases.segments.size(), 3u);
    }
}

TEST(LabelBorder, AFewVoxelsAtTheBorder) {
  const LabelInput labels = make_labels({12, 12, 12}, [](int x, int y, int z) {
    if (x == 11 && y == 5 && z == 5) return 1;
    if (x == 0 && y == 6 && (z == 6 || z == 7)) return 2;
    return length(x - 5.5, y - 5.5, z - 5.5) < 5.4 ? (x < 6 ? 2 : 1) : 0;
  });
  for (const double cell : {0.5, 1.0}) {
    const DenseMesh meshed = checked_mesh(labels, cell);
    // Single voxels are rounded.
    EXPECT_GT(expect_cut_off(labels, meshed.mesh, 0.7), 8u);
    EXPECT_TRUE(meshed.report.creases.segments.empty());
  }
}

TEST(LabelBorder, TheReferenceKnowsThePlanes) {
  const LabelInput labels = make_labels(
      {12, 10, 10}, [](int x, int y, int z) { return x + y + z < 14 ? 1 : 0; }, several_directions()[1],
      Vec3(4, 5, 6));
  const DenseMesh meshed = checked_mesh(labels, 1);
  ASSERT_TRUE(meshed.reference->has_patches());
  const auto at = [&](double x, double y, double z) -> Vec3 {
    return labels.origin + labels.directions * Vec3(x, y, z);
  };
  const Vec3 near = at(3, -0.4, 4);
  const auto on = meshed.reference->onto_patch(near, 1, {}, 3, 1);
  ASSERT_TRUE(on);
  EXPECT_NEAR((labels.directions.inverse() * (*on - labels.origin))[1], -0.5, 1e-12);
  EXPECT_LT((*on - near).norm(), 0.11);
  EXPECT_FALSE(meshed.reference->onto_patch(at(3, 4, 4), 1, {}, 3, 1));
  const auto edge = meshed.reference->onto_crease(at(-0.4, -0.45, 4), 1);
  ASSERT_TRUE(edge);
  EXPECT_LT((*edge - at(-0.5, -0.5, 4)).norm(), 0.2);
  const auto corner = meshed.reference->onto_corner(at(-0.3, -0.3, -0.3), 1);
  ASSERT_TRUE(corner);
  EXPECT_LT((*corner - at(-0.5, -0.5, -0.5)).norm(), 1e-9);
  EXPECT_LT(meshed.reference->signed_distance(at(3, 3, 0.5), 1), 0);
  EXPECT_GT(meshed.reference->signed_distance(at(3, 3, -1), 1), 0);
}

}  // namespace
}  // namespace tetwright::label_border_test

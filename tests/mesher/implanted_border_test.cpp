// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/mesher/checked_labels.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/error.h"

namespace tetwright::implanted_border_test {
namespace {

constexpr MaterialTag body_tag = 9;

/// Two labels that fill a volume.
LabelInput halves(const VoxelIndex& size) {
  return make_labels(size, [&](int x, int, int) { return 2 * x < size[0] ? 1 : 2; });
}

TriangleMesh box_at(const Vec3& centre, const Vec3& half,
                    const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity()) {
  TriangleMesh box = make_box(-half, half);
  for (Vec3& p : box.points) p = centre + axes * p;
  return box;
}

/// Puts bodies, given in voxels, into a volume.
ImplantedVolume implanted(const LabelInput& labels, std::vector<TriangleMesh> surfaces,
                          std::vector<MaterialTag> kept = {}) {
  std::vector<MaterialSurface> bodies;
  for (TriangleMesh& s : surfaces) {
    for (Vec3& p : s.points) p = labels.origin + labels.directions * p;
    const auto number = static_cast<MaterialTag>(bodies.size());
    bodies.push_back({"body" + std::to_string(number), body_tag + number, std::move(s), "body.stl"});
  }
  return make_implanted_volume(labels, make_mesher_input(std::move(bodies)), std::move(kept));
}

DenseMesh checked(const ImplantedVolume& volume, MesherOptions options = cells_of(1)) {
  options.voxel_size *= volume.labels.directions.colwise().norm().minCoeff();
  DenseMesh dense = mesh_implanted(volume, options, nullptr);
  for (const MeshFinding& f : check_mesh(dense.mesh)) ADD_FAILURE() << mesh_finding_line(f);
  return dense;
}

/// Volumes of materials in voxels.
std::map<MaterialTag, double> volumes(const DenseMesh& dense, const LabelInput& labels) {
  std::map<MaterialTag, double> all;
  const TetMesh& mesh = dense.mesh;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    all[mesh.materials[t]] += tet_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) /
                              std::abs(labels.directions.determinant());
  }
  return all;
}

struct Border {
  std::map<std::string, double> areas;  ///< of patches by name, voxel faces; of a volume with equal spacings
  double off = 0;                       ///< largest distance of labels beyond the border, voxels
};

/// The faces of labels on the border of the volume.
Border border_of(const DenseMesh& dense, const LabelInput& labels) {
  Border border;
  const TetMesh& mesh = dense.mesh;
  const Eigen::Matrix3d to_index = labels.directions.inverse();
  const auto index = [&](Index p) -> Vec3 { return to_index * (mesh.points[p] - labels.origin); };
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.materials[t] >= body_tag) continue;
    for (const Index p : mesh.tets[t])
      for (int a = 0; a < 3; ++a)
        border.off = std::max(
            {border.off, -0.5 - index(p)[a], index(p)[a] - (labels.size[static_cast<std::size_t>(a)] - 0.5)});
  }
  for (const InterfaceTriangle& t : mesh.interfaces) {
    if (t.other || t.material >= body_tag || t.patch == 0) continue;
    const Vec3 p = index(t.ids[0]), q = index(t.ids[1]), r = index(t.ids[2]);
    const std::string& name = mesh.patch_groups.at({t.pair(), t.patch}).name;
    border.areas[name.substr(name.find(':') + 1)] += 0.5 * (q - p).cross(r - p).norm();
  }
  return border;
}

double sum(const std::map<MaterialTag, double>& all) {
  double total = 0;
  for (const auto& [tag, volume] : all) total += volume;
  return total;
}

TEST(ImplantedBorder, LabelsEndAtTheBorderThatABodyCrosses) {
  const LabelInput labels = halves({16, 14, 12});
  const ImplantedVolume volume = implanted(labels, {box_at(Vec3(7.3, 6.6, 13.2), Vec3(2.2, 1.7, 5.1))});
  ASSERT_EQ(volume.bodies.findings.size(), 1u);
  EXPECT_EQ(volume.bodies.findings[0].code, DiagnosticCode::volume_enlarged);
  EXPECT_EQ(volume.labels.size, labels.size);
  const DenseMesh dense = checked(volume);
  const auto is = volumes(dense, labels);
  EXPECT_NEAR(is.at(body_tag), 8 * 2.2 * 1.7 * 5.1, 1e-3);
  const double inside = 4 * 2.2 * 1.7 * (11.5 - 8.1);
  EXPECT_NEAR(is.at(1) + is.at(2), 16 * 14 * 12 - inside, 1e-3);
  const Border border = border_of(dense, labels);
  EXPECT_LT(border.off, 1e-12);
  EXPECT_EQ(border.areas.size(), 6u);
  EXPECT_NEAR(border.areas.at("border_z_max"), 16 * 14 - 4 * 2.2 * 1.7, 1e-2);
  EXPECT_NEAR(border.areas.at("border_z_min"), 16 * 14, 1e-6);
  // The corners of the volume and of the box.
  EXPECT_EQ(dense.report.creases.corners.size(), 16u);
}

TEST(ImplantedBorder, BodiesMayCrossEdgesOfTurnedAndMirroredVolumes) {
  LabelInput labels = halves({12, 13, 11});
  labels.directions = Eigen::AngleAxisd(0.5, Vec3(1, 2, 2) / 3).toRotationMatrix() * 0.7;
  labels.directions.col(2) *= -1;
  labels.origin = Vec3(30, -20, 5);
  const Vec3 half(2.1, 1.8, 2.3);
  const ImplantedVolume volume = implanted(labels, {box_at(Vec3(11.2, 6, -0.3), half)});
  const DenseMesh dense = checked(volume);
  const auto is = volumes(dense, labels);
  EXPECT_NEAR(is.at(body_tag), 8 * half.prod(), 1e-6);
  const double inside = (11.5 - 9.1) * 2 * 1.8 * (2.0 + 0.5);
  EXPECT_NEAR(is.at(1) + is.at(2), 12 * 13 * 11 - inside, 1e-6);
  EXPECT_LT(border_of(dense, labels).off, 1e-9);
}

TEST(ImplantedBorder, BodiesInsideChangeNothingAboutTheBorder) {
  const LabelInput labels = halves({16, 14, 12});
  const Vec3 half(2.2, 1.7, 2.4);
  for (const double gap : {0.3, 0.9, 1.6}) {
    const ImplantedVolume volume = implanted(labels, {box_at(Vec3(7.3, 6.6, 11.5 - gap - half[2]), half)});
    EXPECT_TRUE(volume.bodies.findings.empty());
    const DenseMesh dense = checked(volume);
    const auto is = volumes(dense, labels);
    EXPECT_NEAR(is.at(body_tag), 8 * half.prod(), 1e-6) << gap;
    EXPECT_NEAR(sum(is), 16 * 14 * 12, 1e-6) << gap;
    const Border border = border_of(dense, labels);
    EXPECT_NEAR(border.areas.at("border_z_max"), 16 * 14, 1e-6) << gap;
    EXPECT_EQ(border.areas.size(), 6u) << gap;
  }
}

TEST(ImplantedBorder, FacesOfBodiesInTheBorderAreInItsPlane) {
  const LabelInput labels = halves({12, 12, 12});
  // In one side, in three sides, and across the whole volume.
  const std::vector<std::pair<Vec3, Vec3>> boxes = {{Vec3(3.3, 4.2, 6.4), Vec3(8.1, 8.7, 11.5)},
                                                    {Vec3(-0.5, -0.5, -0.5), Vec3(4.3, 5.2, 3.6)},
                                                    {Vec3(4.5, -0.5, -0.5), Vec3(7.2, 11.5, 11.5)}};
  for (const auto& [low, high] : boxes) {
    const ImplantedVolume volume = implanted(labels, {make_box(low, high)});
    EXPECT_TRUE(volume.bodies.findings.empty());
    const DenseMesh dense = checked(volume);
    const auto is = volumes(dense, labels);
    EXPECT_NEAR(is.at(body_tag), (high - low).prod(), 1e-3) << high.transpose();
    EXPECT_NEAR(sum(is), 12 * 12 * 12, 1e-6) << high.transpose();
    for (const Vec3& p : dense.mesh.points)
      EXPECT_LE((p - Vec3::Constant(5.5)).cwiseAbs().maxCoeff(), 6 + 1e-12);
    // The six faces of the box keep their patches.
    std::set<std::uint16_t> patches;
    for (const InterfaceTriangle& t : dense.mesh.interfaces)
      if (t.material == body_tag || t.other == body_tag) patches.insert(t.patch);
    EXPECT_EQ(patches.size(), 6u) << high.transpose();
  }
}

TEST(ImplantedBorder, ObliqueSidesKeepToTheirFaceInTheBorder) {
  const LabelInput labels = halves({16, 16, 12});
  TriangleMesh frustum = make_box(Vec3(4.2, 4.4, -0.5), Vec3(11.3, 11.1, 5.2));
  for (Vec3& p : frustum.points)
    if (p[2] > 0) p.head<2>() = Vec3(7.5, 7.5, 0).head<2>() + 0.5 * (p - Vec3(7.5, 7.5, 0)).head<2>();
  double expected = 0;
  for (const Triangle& t : frustum.triangles)
    expected += frustum.points[t[0]].dot(frustum.points[t[1]].cross(frustum.points[t[2]])) / 6;
  const ImplantedVolume volume = implanted(labels, {frustum});
  const DenseMesh dense = checked(volume);
  const auto is = volumes(dense, labels);
  EXPECT_NEAR(is.at(body_tag), expected, 1e-4 * expected);
  EXPECT_NEAR(sum(is), 16 * 16 * 12, 1e-6);
}

TEST(ImplantedBorder, TheKeptOutsideEndsAtTheBorder) {
  const LabelInput labels =
      make_labels({14, 14, 12}, [](int x, int y, int z) { return length(x - 6.5, y - 6.5, z - 5.5) < 4.6; });
  const ImplantedVolume volume = implanted(labels, {box_at(Vec3(6.6, 6.4, 10.2), Vec3(1.3, 1.4, 5.1))});
  MesherOptions options = cells_of(1);
  options.keep_outside = true;
  const DenseMesh dense = checked(volume, options);
  const auto is = volumes(dense, labels);
  EXPECT_NEAR(is.at(body_tag), 8 * 1.3 * 1.4 * 5.1, 1e-3);
  EXPECT_NEAR(is.at(0) + is.at(1), 14 * 14 * 12 - 4 * 1.3 * 1.4 * (11.5 - 5.1), 1e-3);
  EXPECT_LT(border_of(dense, labels).off, 1e-12);
}

TEST(ImplantedBorder, ProtectedLabelsHoldBodiesBackWithinTheBorderOnly) {
  const LabelInput labels = halves({14, 12, 12});
  const ImplantedVolume volume = implanted(labels, {box_at(Vec3(6.5, 5.6, 12.3), Vec3(3.2, 1.8, 4.4))}, {2});
  const DenseMesh dense = checked(volume);
  const auto is = volumes(dense, labels);
  const double section = 4 * 3.2 * 1.8, inside = 11.5 - 7.9, outside = 8.8 - inside;
  EXPECT_NEAR(is.at(body_tag), section * outside + 0.5 * section * inside, 0.02 * section * outside);
  EXPECT_NEAR(is.at(2), 7 * 12 * 12, 0.5);
  EXPECT_LT(border_of(dense, labels).off, 1e-12);
}

TEST(ImplantedBorder, BodiesFarTooLargeForTheVolumeAreRefused) {
  const LabelInput labels = halves({12, 12, 12});
  EXPECT_THROW(implanted(labels, {box_at(Vec3(6000, 5, 5), Vec3(5998, 2, 2))}), InputError);
}

TEST(ImplantedBorder, BodiesBesideProtectedLabelsAloneAreNotCompared) {
  const LabelInput labels = make_labels({20, 14, 12}, [](int x, int, int) { return x < 6 ? 1 : 2; });
  const ImplantedVolume volume = implanted(
      labels, {box_at(Vec3(5.6, 6.6, 5.7), Vec3(2.3, 2.2, 2.4)), box_at(Vec3(14, 6.6, 5.7), Vec3(2, 2, 2))},
      {1});
  const DenseMesh dense = checked(volume);
  ASSERT_EQ(dense.report.expected.size(), 1u);
  EXPECT_EQ(dense.report.expected[0].name, "body1");
  EXPECT_EQ(dense.report.at_protected, std::vector<std::string>{"body0"});
  EXPECT_NEAR(volumes(dense, labels).at(body_tag + 1), 64, 1e-6);
}

TEST(ImplantedBorder, LabelsThatABodyCoversAreRefusedAlsoWithProtectedOnes) {
  const LabelInput labels = make_labels({24, 14, 12}, [](int x, int y, int z) {
    if (x < 5) return 3;
    return x > 13 && x < 18 && y > 4 && y < 9 && z > 3 && z < 8 ? 2 : 1;
  });
  const ImplantedVolume volume =
      implanted(labels, {make_box(Vec3(13.4, 4.4, 3.4), Vec3(17.6, 8.6, 7.6))}, {3});
  try {
    mesh_implanted(volume, cells_of(0.5), nullptr);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("nothing is left of 'label_2'"), std::string::npos) << e.what();
  }
}

TEST(ImplantedBorder, BodiesInsideProtectedLabelsAreRefused) {
  const LabelInput labels = halves({20, 14, 12});
  const ImplantedVolume volume = implanted(labels, {box_at(Vec3(4, 6.6, 5.7), Vec3(2.3, 2.2, 2.4))}, {1});
  try {
    mesh_implanted(volume, cells_of(1), nullptr);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("--protect-labels"), std::string::npos) << e.what();
  }
}

TEST(ImplantedBorder, ThinRodsInLongVoxelsTakeTheirVolume) {
  LabelInput labels = halves({24, 24, 6});
  labels.directions = Vec3(0.5, 0.5, 5).asDiagonal();
  // Between voxel centres along z.
  const ImplantedVolume volume = implanted(labels, {box_at(Vec3(11.5, 11.5, 2.5), Vec3(8, 1.2, 0.12))});
  const DenseMesh dense = checked(volume);
  double taken = 0;
  for (const auto& [label, voxels] : dense.report.carved->voxels) taken += voxels;
  EXPECT_NEAR(taken, 8 * 8 * 1.2 * 0.12, 0.05 * 8 * 8 * 1.2 * 0.12);
}

/// A gap of labels between a face of a body at x = 10 and the interface of the labels at x = 9.5.
TEST(ImplantedBorder, GapsThatCellsDoNotResolveAreNamed) {
  const LabelInput labels = halves({20, 14, 12});
  const ImplantedVolume volume = implanted(labels, {make_box(Vec3(10, 4, 3), Vec3(15, 9, 8))});
  EXPECT_EQ(checked(volume).report.narrow_labels.places, 0u);
  MesherOptions options = cells_of(1);
  options.max_refinement = 0;
  const NarrowLabelsReport narrow = checked(volume, options).report.narrow_labels;
  EXPECT_GT(narrow.places, 20u);
  EXPECT_TRUE(narrow.first.x() >= 9.49 && narrow.first.x() <= 10) << narrow.first.transpose();
  // Without such a gap: away from the interface, and in it.
  for (const double x : {11.5, 9.5}) {
    const ImplantedVolume other = implanted(labels, {make_box(Vec3(x, 4, 3), Vec3(15, 9, 8))});
    EXPECT_EQ(checked(other, options).report.narrow_labels.places, 0u) << x;
  }
  // A gap at the border of less than any cell.
  const ImplantedVolume near = implanted(labels, {make_box(Vec3(12, 4, 3), Vec3(19.4, 9, 8))});
  const NarrowLabelsReport at_border = checked(near).report.narrow_labels;
  EXPECT_EQ(at_border.places, 0u);
  EXPECT_GT(at_border.at_border, 20u);
}

TEST(ImplantedBorder, BodiesOffAllLabelsAreNamed) {
  const LabelInput labels = make_labels({20, 14, 12}, [](int x, int, int) { return x < 6 ? 1 : 0; });
  const ImplantedVolume volume = implanted(labels, {box_at(Vec3(14, 6.6, 5.7), Vec3(2, 2, 2))});
  EXPECT_EQ(checked(volume).report.off_labels, std::vector<std::string>{"body0"});
}

}  // namespace
}  // namespace tetwright::implanted_border_test

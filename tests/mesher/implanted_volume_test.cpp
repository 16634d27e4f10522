// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/random.h"
#include "mesher/body_field.h"
#include "mesher/labels/carved_field.h"
#include "mesher/level_sets/level_set_field.h"
#include "tests/mesher/checked_labels.h"
#include "tests/mesher/test_surfaces.h"
#include "tetwright/error.h"

namespace tetwright::implanted_volume_test {
namespace {

Eigen::Matrix3d turn() { return (Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized())).toRotationMatrix(); }

TriangleMesh turned_box(const Vec3& centre, const Vec3& half, const Eigen::Matrix3d& axes = turn()) {
  TriangleMesh box = make_box(-half, half);
  for (Vec3& p : box.points) p = centre + axes * p;
  return box;
}

MesherInput body(const TriangleMesh& surface, const std::string& name = "implant", MaterialTag tag = 9) {
  return make_mesher_input({{name, tag, surface, name + ".stl"}});
}

/// Three layers across z in a ball.
LabelInput layers(int side) {
  return make_labels({side, side, side}, [&](int x, int y, int z) {
    const double c = 0.5 * (side - 1);
    if (length(x - c, y - c, z - c) > 0.5 * side - 1.5) return 0;
    return z < c - 3 ? 1 : z < c + 2 ? 2 : 3;
  });
}

DenseMesh checked(const ImplantedVolume& volume, double cell) {
  DenseMesh dense = mesh_implanted(volume, cells_of(cell), nullptr);
  for (const MeshFinding& f : check_mesh(dense.mesh)) ADD_FAILURE() << mesh_finding_line(f);
  EXPECT_EQ(broken_promise(dense.mesh.points, dense.mesh.tets), "");
  return dense;
}

std::map<MaterialTag, double> volumes(const TetMesh& mesh) {
  std::map<MaterialTag, double> all;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    all[mesh.materials[t]] += tet_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
  }
  return all;
}

/// Largest distance of the vertices of a material's faces from the planes of a turned box.
double off_box(const TetMesh& mesh, MaterialTag tag, const Vec3& centre, const Vec3& half,
               const Eigen::Matrix3d& axes = turn()) {
  double worst = 0;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    if (t.material != tag && t.other != tag) continue;
    for (const Index p : t.ids) {
      const Vec3 at = (axes.transpose() * (mesh.points[p] - centre)).cwiseAbs() - half;
      worst = std::max(worst, std::abs(at.maxCoeff()));
    }
  }
  return worst;
}

TEST(ImplantedVolume, BoxThroughThreeLabelsKeepsItsEdges) {
  const Vec3 centre(11.3, 11.8, 11.6), half(3.1, 2.4, 6.3);
  const LabelInput labels = layers(24);
  const ImplantedVolume volume = make_implanted_volume(labels, body(turned_box(centre, half)));
  const DenseMesh dense = checked(volume, 1);
  EXPECT_LT(off_box(dense.mesh, 9, centre, half), 1e-9);
  const auto is = volumes(dense.mesh);
  EXPECT_NEAR(is.at(9), 8 * half.prod(), 1e-6 * half.prod());
  ASSERT_TRUE(dense.report.carved);
  double taken = 0;
  for (const auto& [label, voxels] : dense.report.carved->voxels) taken += voxels;
  EXPECT_NEAR(taken, 8 * half.prod(), 0.01 * 8 * half.prod());
  for (const LabelMaterial& m : labels.materials) {
    const double expected = static_cast<double>(m.voxels) - dense.report.carved->voxels.at(m.tag);
    EXPECT_NEAR(is.at(m.tag), expected, 0.01 * expected) << m.name;
  }
  expect_line(dense.mesh, "material 9: " + disc);
  // Each label is one piece, and so are all contacts with the box.
  for (const MaterialTag tag : {1, 2, 3})
    EXPECT_NE(text(dense.mesh).find("material " + std::to_string(tag) + ": components 1"), std::string::npos)
        << text(dense.mesh);
  std::set<std::uint16_t> patches;
  for (const InterfaceTriangle& t : dense.mesh.interfaces)
    if (t.material == 9 || t.other == 9) patches.insert(t.patch);
  EXPECT_EQ(patches.size(), 6u);
  EXPECT_EQ(dense.report.creases.corners.size(), 8u);
}

TEST(ImplantedVolume, FacesOnTheBorderKeepTheirPatches) {
  const LabelInput labels = make_labels({20, 18, 16}, [](int x, int, int) { return x < 9 ? 1 : 2; });
  const Vec3 centre(9.2, 8.7, 7.4), half(2.6, 3.1, 2.2);
  const ImplantedVolume volume = make_implanted_volume(labels, body(turned_box(centre, half)));
  EXPECT_TRUE(volume.bodies.findings.empty());
  const DenseMesh dense = checked(volume, 1);
  std::map<std::uint16_t, double> areas;
  for (const InterfaceTriangle& t : dense.mesh.interfaces) {
    if (t.other) continue;
    const auto& [a, b, c] = t.ids;
    const Vec3 &p = dense.mesh.points[a], &q = dense.mesh.points[b], &r = dense.mesh.points[c];
    areas[t.patch] += 0.5 * (q - p).cross(r - p).norm();
  }
  EXPECT_EQ(areas.size(), 6u);
  EXPECT_NEAR(areas[1], 18 * 16, 1e-6);
  EXPECT_NEAR(areas[4], 20 * 16, 1e-6);
  std::set<std::string> names;
  for (const auto& [patch, group] : dense.mesh.patch_groups) names.insert(group.name);
  EXPECT_TRUE(names.contains("border_x_min")) << *names.begin();
  // Corners and edges of the volume as well as those of the box.
  EXPECT_EQ(dense.report.creases.corners.size(), 16u);
  const std::optional<Vec3> corner = dense.reference->onto_corner(Vec3(-0.4, -0.4, -0.4), 1);
  ASSERT_TRUE(corner);
  EXPECT_LT((*corner - Vec3(-0.5, -0.5, -0.5)).norm(), 1e-9);
}

TEST(ImplantedVolume, BodiesThatLeaveTheVolumeAreWhole) {
  const LabelInput labels = layers(16);
  const Vec3 centre(7.5, 7.5, 16), half(1.7, 1.6, 7);
  const ImplantedVolume volume =
      make_implanted_volume(labels, body(turned_box(centre, half, Eigen::Matrix3d::Identity())));
  ASSERT_EQ(volume.bodies.findings.size(), 1u);
  EXPECT_EQ(volume.bodies.findings[0].code, DiagnosticCode::volume_enlarged);
  EXPECT_EQ(volume.labels.size, labels.size);
  const DenseMesh dense = checked(volume, 1);
  EXPECT_NEAR(volumes(dense.mesh).at(9), 8 * half.prod(), 1e-5 * half.prod());
}

TEST(ImplantedVolume, ProtectedLabelsAreNotCarved) {
  const Vec3 centre(11.3, 11.8, 11.6), half(3.1, 2.4, 6.3);
  const LabelInput labels = layers(24);
  const DenseMesh alone = mesh_labels(labels, cells_of(1), nullptr);
  const DenseMesh dense = checked(make_implanted_volume(labels, body(turned_box(centre, half)), {2}), 1);
  EXPECT_NEAR(volumes(dense.mesh).at(2), volumes(alone.mesh).at(2), 0.005 * volumes(alone.mesh).at(2));
  EXPECT_FALSE(dense.report.carved->voxels.contains(2));
  EXPECT_NE(text(dense.mesh).find("material 9: components 2"), std::string::npos) << text(dense.mesh);
}

TEST(ImplantedVolume, BodiesThatTouchShareTheirFaces) {
  const LabelInput labels = layers(24);
  const MesherInput two =
      make_mesher_input({{"left", 8, make_box(Vec3(6.2, 8.1, 7.3), Vec3(11.4, 14.6, 15.9)), "left.stl"},
                         {"right", 9, make_box(Vec3(11.4, 8.1, 7.3), Vec3(16.7, 14.6, 15.9)), "right.stl"}});
  ASSERT_TRUE(two.complex);
  const DenseMesh dense = checked(make_implanted_volume(labels, two), 1);
  double shared = 0;
  for (const InterfaceTriangle& t : dense.mesh.interfaces) {
    if (t.pair() != std::pair<MaterialTag, MaterialOrOutside>(8, 9)) continue;
    const auto& [a, b, c] = t.ids;
    for (const Index p : t.ids) EXPECT_NEAR(dense.mesh.points[p][0], 11.4, 1e-9);
    shared += 0.5 * (dense.mesh.points[b] - dense.mesh.points[a])
                        .cross(dense.mesh.points[c] - dense.mesh.points[a])
                        .norm();
  }
  EXPECT_NEAR(shared, 6.5 * 8.6, 1e-6);
  EXPECT_NEAR(volumes(dense.mesh).at(8), 5.2 * 6.5 * 8.6, 1e-6);
}

TEST(ImplantedVolume, NeedsBodiesThatFit) {
  const LabelInput labels = layers(12);
  const auto make = [&](const Vec3& at, const std::string& name, MaterialTag tag,
                        std::vector<MaterialTag> kept) {
    return make_implanted_volume(labels, body(turned_box(at, Vec3(2, 2, 2)), name, tag), std::move(kept));
  };
  EXPECT_THROW(make(Vec3(40, 5, 5), "implant", 9, {}), InputError);
  EXPECT_THROW(make(Vec3(5, 5, 5), "label_2", 9, {}), UsageError);
  EXPECT_THROW(make(Vec3(5, 5, 5), "implant", 2, {}), UsageError);
  EXPECT_THROW(make(Vec3(5, 5, 5), "implant", 9, {7}), UsageError);
  EXPECT_THROW(make(Vec3(5, 5, 5), "outside", 9, {}), UsageError);
  try {
    make(Vec3(40, 5, 5), "implant", 9, {});
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("implant.stl"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("(-0.5, -0.5, -0.5)"), std::string::npos) << e.what();
  }
}

/// Distances, margins and gradients agree with each other.
void expect_consistent(const MaterialField& field, std::uint64_t seed) {
  Random random(seed);
  const std::unique_ptr<FieldSampler> sampler = field.sampler();
  std::vector<RegionIndex> all(field.regions().size());
  for (std::size_t r = 0; r < all.size(); ++r) all[r] = static_cast<RegionIndex>(r);
  std::vector<float> values(all.size());
  std::size_t second_found = 0;
  for (int i = 0; i < 4000; ++i) {
    Vec3 p;
    for (int a = 0; a < 3; ++a) p[a] = (0.1 + 0.8 * random.uniform()) * field.frame().box[a];
    const NearestRegion nearest = sampler->nearest(p);
    sampler->values(p, all, values.data());
    std::vector<float> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(values[nearest.region], sorted[0]);
    const float margin = std::min(0.5f * (sorted[1] - sorted[0]), static_cast<float>(field.band()));
    EXPECT_NEAR(nearest.margin, margin, 1e-4) << p.transpose();
    const std::optional<RegionSet> two = sampler->two_nearest(p);
    if (margin < 0.9 && sorted[2] - sorted[1] > 1e-3) {
      ASSERT_TRUE(two) << p.transpose();
      for (const RegionIndex r : *two) EXPECT_LE(values[r], sorted[1] + 1e-4) << p.transpose();
      ++second_found;
    }
  }
  EXPECT_GT(second_found, 200u);
}

struct CarvedFieldFixture : ::testing::Test {
  static std::shared_ptr<const CarvedField> make(std::vector<std::uint8_t> kept, double cell = 1) {
    const ImplantedVolume volume =
        make_implanted_volume(layers(16), body(turned_box(Vec3(7.6, 7.2, 7.4), Vec3(2.1, 2.4, 3.9))));
    const GridFrame frame = label_frame(volume.labels, cell, false);
    const BodyField bodies = build_field(volume.bodies, frame, false, {}, {}, {}, nullptr);
    return CarvedField::make(LabelField::make(volume.labels, frame, false, nullptr), bodies.field,
                             std::move(kept), 0.25);
  }
};

TEST_F(CarvedFieldFixture, DistancesAndRegionsAgree) {
  expect_consistent(*make({}), 1);
  expect_consistent(*make({}, 0.5), 2);
  expect_consistent(*make({0, 0, 1, 0}), 3);
  expect_consistent(*make({})->refined(1), 4);
}

TEST_F(CarvedFieldFixture, PointsMoveToWhereThreeRegionsMeet) {
  const auto field = make({});
  const std::unique_ptr<FieldSampler> sampler = field->sampler();
  Random random(5);
  RegionSet three;
  for (const int r : {1, 2, 4}) three.insert(static_cast<RegionIndex>(r));
  int tried = 0, moved = 0;
  for (int i = 0; i < 20000; ++i) {
    Vec3 p;
    for (int a = 0; a < 3; ++a) p[a] = (0.2 + 0.6 * random.uniform()) * field->frame().box[a];
    float values[3];
    const RegionIndex regions[3] = {1, 2, 4};
    sampler->values(p, regions, values);
    const auto [low, high] = std::minmax_element(values, values + 3);
    if (*high - *low > 0.8 || sampler->nearest(p).margin > 0.8 || *low > 0) continue;
    ++tried;
    if (!sampler->project(three, p)) continue;
    ++moved;
    sampler->values(p, regions, values);
    EXPECT_NEAR(values[0], values[1], 3e-3);
    EXPECT_NEAR(values[0], values[2], 3e-3);
  }
  EXPECT_GT(tried, 20);
  EXPECT_GT(moved, 0.9 * tried);
}

TEST_F(CarvedFieldFixture, GradientsAreThoseOfTheDistances) {
  for (const std::vector<std::uint8_t>& kept : {std::vector<std::uint8_t>{}, {0, 0, 1, 0}}) {
    const auto field = make(kept);
    const std::unique_ptr<FieldSampler> sampler = field->sampler();
    Random random(6);
    int tried = 0, right = 0;
    for (int i = 0; i < 3000; ++i) {
      Vec3 p;
      for (int a = 0; a < 3; ++a) p[a] = (0.2 + 0.6 * random.uniform()) * field->frame().box[a];
      if (sampler->nearest(p).margin > 1) continue;
      const auto two = sampler->two_nearest(p);
      if (!two) continue;
      const RegionIndex a = *two->begin(), b = *(two->begin() + 1);
      Vec3 gradient, unused;
      constexpr double step = 1e-4;
      const double at = sampler->between(a, b, p, gradient);
      const Vec3 direction = Vec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
      const double by = (sampler->between(a, b, p + step * direction, unused) - at) / step;
      ++tried;
      right += std::abs(by - gradient.dot(direction)) < 1e-2;
    }
    EXPECT_GT(tried, 300);
    EXPECT_GT(right, 0.97 * tried);  // but for kinks
  }
}

}  // namespace
}  // namespace tetwright::implanted_volume_test

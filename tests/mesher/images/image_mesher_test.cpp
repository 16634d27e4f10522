// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "common/random.h"
#include "mesher/labels/image_bricks.h"
#include "tests/mesher/checked_labels.h"
#include "tests/mesher/label_volumes.h"
#include "tetwright/error.h"
#include "tetwright/image_input.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"

namespace tetwright::image_mesher_test {
namespace {

using Function = std::function<double(const Vec3&)>;

/// Samples functions of the index at voxel centres.
ImageVolume image_of(const std::array<int, 3>& size, const std::vector<Function>& functions) {
  ImageVolume image;
  image.size = size;
  for (const Function& f : functions) {
    std::vector<float>& channel = image.channels.emplace_back();
    for (int z = 0; z < size[2]; ++z)
      for (int y = 0; y < size[1]; ++y)
        for (int x = 0; x < size[0]; ++x) channel.push_back(static_cast<float>(f(Vec3(x, y, z))));
  }
  return image;
}

LabelInput input_of(const ImageVolume& image, const ImageChoice& choice) {
  return make_image_input(image, "image", choice, nullptr, nullptr);
}

ImageChoice above(double value) {
  ImageChoice choice;
  choice.isos = {{"body", value}};
  return choice;
}

double volume_of(const TetMesh& mesh, MaterialTag tag) {
  double volume = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.materials[t] != tag) continue;
    const auto& [a, b, c, d] = mesh.tets[t];
    volume += (mesh.points[b] - mesh.points[a])
                  .cross(mesh.points[c] - mesh.points[a])
                  .dot(mesh.points[d] - mesh.points[a]) /
              6;
  }
  return volume;
}

/// Trilinear interpolation; the outermost values continue.
double trilinear(const ImageVolume& image, const Vec3& at, std::size_t channel = 0) {
  std::array<int, 3> low, high;
  Vec3 share;
  for (int a = 0; a < 3; ++a) {
    const double along = std::clamp(at[a], 0.0, image.size[a] - 1.0);
    low[a] = static_cast<int>(along);
    high[a] = std::min(low[a] + 1, image.size[a] - 1);
    share[a] = along - low[a];
  }
  double value = 0;
  for (int k = 0; k < 8; ++k) {
    const bool x = k & 1, y = k >> 1 & 1, z = k >> 2;
    value += (x ? share[0] : 1 - share[0]) * (y ? share[1] : 1 - share[1]) * (z ? share[2] : 1 - share[2]) *
             static_cast<double>(image.channels[channel][static_cast<std::size_t>(
                 ((z ? high : low)[2] * image.size[1] + (y ? high : low)[1]) * image.size[0] +
                 (x ? high : low)[0])]);
  }
  return value;
}

/// Root mean square and 99th percentile of `distance` at points of interfaces that are not on the border of
/// the volume.
struct Misses {
  double rms = 0, most = 0;
};
Misses misses(const TetMesh& mesh, const Function& distance) {
  std::vector<std::uint8_t> on(mesh.points.size(), 0), border(mesh.points.size(), 0);
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids) (t.patch ? border : on)[p] = 1;
  std::vector<double> all;
  Misses result;
  for (std::size_t p = 0; p < on.size(); ++p) {
    if (!on[p] || border[p]) continue;
    all.push_back(std::abs(distance(mesh.points[p])));
    result.rms += all.back() * all.back();
  }
  result.rms = std::sqrt(result.rms / static_cast<double>(all.size()));
  std::sort(all.begin(), all.end());
  result.most = all[all.size() * 99 / 100];
  return result;
}

TEST(ImageMesher, PointsAreWhereTheTrilinearImageHasTheThreshold) {
  // Contrast that changes by a factor of four along the surface.
  const Vec3 centre(12.3, 11.8, 12.1);
  const ImageVolume image = image_of(
      {25, 24, 26}, {[&](const Vec3& p) { return 100 + (40 - 1.2 * p[0]) * (8.2 - (p - centre).norm()); }});
  for (const double cell : {1.0, 0.5, 1.5}) {
    const DenseMesh made = checked_mesh(input_of(image, above(100)), cells_of(cell, 0));
    const auto distance = [&](const Vec3& p) { return (trilinear(image, p) - 100) / (40 - 1.2 * p[0]); };
    const Misses found = misses(made.mesh, distance);
    EXPECT_LT(found.rms, 0.015) << cell;
    EXPECT_LT(found.most, cell > 1 ? 0.1 : 0.03) << cell;
  }
}

TEST(ImageMesher, NestedMaterialsAtTheirThresholds) {
  const Vec3 centre(11.6, 12.2, 11.9);
  const ImageVolume image = image_of({24, 24, 24}, {[&](const Vec3& p) { return -(p - centre).norm(); }});
  ImageChoice choice;
  choice.isos = {{"core", -4.0}, {"shell", -9.0}, {"middle", -6.0}};
  const LabelInput input = input_of(image, choice);
  ASSERT_EQ(input.materials.size(), 3u);
  EXPECT_EQ(input.materials[0].name, "core");
  EXPECT_EQ(input.materials[2].tag, 3);
  const DenseMesh made = checked_mesh(input, 0.5);
  const auto ball = [](double r) { return 4.0 / 3 * std::numbers::pi * r * r * r; };
  EXPECT_NEAR(volume_of(made.mesh, 1), ball(4), 0.05 * ball(4));
  EXPECT_NEAR(volume_of(made.mesh, 3), ball(6) - ball(4), 0.05 * ball(6));
  EXPECT_NEAR(volume_of(made.mesh, 2), ball(9) - ball(6), 0.02 * ball(9));
  for (const InterfaceTriangle& t : made.mesh.interfaces)
    for (const Index p : t.ids) {
      const double radius = (made.mesh.points[p] - centre).norm();
      const double nearest = std::min({std::abs(radius - 4), std::abs(radius - 6), std::abs(radius - 9)});
      EXPECT_LT(nearest, 0.1);
    }
}

TEST(ImageMesher, LayersThinnerThanAVoxelStayWhereTheyAre) {
  // A ramp of 4 units per voxel: the layer between the thresholds is 1.25 voxels thick.
  const ImageVolume image =
      image_of({20, 20, 20}, {[](const Vec3& p) { return 4 * (p[0] + 0.31 * p[1] - 12.4); }});
  ImageChoice choice;
  choice.isos = {{"layer", 0.0}, {"rest", 5.0}};
  const DenseMesh made = checked_mesh(input_of(image, choice), 0.5);
  EXPECT_NEAR(volume_of(made.mesh, 1), 20 * 20 * 1.25, 0.02 * 500);
  const Misses found = misses(made.mesh, [&](const Vec3& p) {
    const double value = trilinear(image, p);
    return std::min(std::abs(value), std::abs(value - 5)) / 4;
  });
  EXPECT_LT(found.most, 0.03);
}

TEST(ImageMesher, ChannelsMeetWhereTheyAreEqual) {
  const Vec3 a(8.2, 11.7, 12.1), b(16.4, 12.3, 11.8);
  const auto near = [](const Vec3& centre) {
    return [=](const Vec3& p) { return 1 / (1 + std::exp((p - centre).norm() - 6)); };
  };
  ImageVolume image = image_of({25, 24, 24}, {near(a), near(b)});
  for (std::size_t i = 0; i < image.channels[0].size(); ++i) {
    const float sum = std::max(1.0F, image.channels[0][i] + image.channels[1][i]);
    image.channels[0][i] /= sum;
    image.channels[1][i] /= sum;
  }
  ImageChoice choice;
  choice.names = {"a", "b"};
  const DenseMesh made = checked_mesh(input_of(image, choice), cells_of(0.5, 0));
  std::size_t between = 0;
  for (const InterfaceTriangle& t : made.mesh.interfaces)
    between += t.pair() == std::pair<MaterialTag, MaterialOrOutside>{1, 2};
  EXPECT_GT(between, 50u);
  // Half the difference of the two largest, by its slope.
  const Misses found = misses(made.mesh, [&](const Vec3& p) {
    const double first = trilinear(image, p), second = trilinear(image, p, 1), rest = 1 - first - second;
    std::array<double, 3> all{first, second, rest};
    std::sort(all.begin(), all.end());
    return (all[2] - all[1]) / 2 / 0.2;
  });
  EXPECT_LT(found.rms, 0.03);
  EXPECT_LT(found.most, 0.1);
}

TEST(ImageMesher, TheOutsideDoesNotComeBetweenMapsThatAddUpToOne) {
  // It has the value of both on all of their interface.
  const Function left = [](const Vec3& p) { return 1 / (1 + std::exp(1.3 * (p[0] - 9.5))); };
  const Function right = [&](const Vec3& p) { return 1 - left(p); };
  ImageChoice choice;
  choice.names = {"left", "right"};
  choice.outside = 0.5;
  const DenseMesh made = checked_mesh(input_of(image_of({20, 18, 16}, {left, right}), choice), 1.0);
  for (const InterfaceTriangle& t : made.mesh.interfaces) EXPECT_TRUE(t.other || t.patch != 0);
  EXPECT_NEAR(volume_of(made.mesh, 1) + volume_of(made.mesh, 2), 20 * 18 * 16, 1);
}

TEST(ImageMesher, AnOutsideValueBoundsChannels) {
  const Vec3 centre(9.5, 9.5, 9.5);
  const ImageVolume image = image_of({20, 20, 20}, {[&](const Vec3& p) { return 7 - (p - centre).norm(); }});
  ImageChoice choice;
  choice.names = {"ball"};
  choice.outside = 2;
  const DenseMesh made = checked_mesh(input_of(image, choice), 0.5);
  const Misses found = misses(made.mesh, [&](const Vec3& p) { return (p - centre).norm() - 5; });
  EXPECT_LT(found.rms, 0.06);
  choice.outside.reset();
  EXPECT_THROW(input_of(image, choice), InputError);
}

TEST(ImageMesher, GyroidsAndBallsOfAnyResolution) {
  for (const double period : {8.0, 16.0}) {
    const double k = 2 * std::numbers::pi / period;
    const Function gyroid = [&](const Vec3& p) {
      return std::sin(k * p[0]) * std::cos(k * p[1]) + std::sin(k * p[1]) * std::cos(k * p[2]) +
             std::sin(k * p[2]) * std::cos(k * p[0]);
    };
    const Function distance = [&](const Vec3& p) {
      const Vec3 slope(
          k * (std::cos(k * p[0]) * std::cos(k * p[1]) - std::sin(k * p[2]) * std::sin(k * p[0])),
          k * (std::cos(k * p[1]) * std::cos(k * p[2]) - std::sin(k * p[0]) * std::sin(k * p[1])),
          k * (std::cos(k * p[2]) * std::cos(k * p[0]) - std::sin(k * p[1]) * std::sin(k * p[2])));
      return gyroid(p) / slope.norm();
    };
    const ImageVolume image = image_of({17, 17, 17}, {gyroid});
    const DenseMesh made = checked_mesh(input_of(image, above(0)), 0.5);
    EXPECT_LT(misses(made.mesh, distance).rms, 0.05) << period;
  }
}

TEST(ImageMesher, NoiseIsMergedAndLeavesNoIslands) {
  Random random(3);
  ImageVolume image = image_of({20, 20, 20}, {[](const Vec3& p) { return p[0] < 9.6 ? 1.0 : 0.0; }});
  for (float& v : image.channels[0])
    if (random.below(60) == 0) v = 1 - v;
  const LabelInput input = input_of(image, above(0.5));
  EXPECT_GT(input.merged_islands, 50u);
  const DenseMesh made = checked_mesh(input, 0.5);
  EXPECT_NEAR(volume_of(made.mesh, 1), 20 * 20 * 10, 100);
  for (const InterfaceTriangle& t : made.mesh.interfaces)
    for (const Index p : t.ids) {
      const Vec3& at = made.mesh.points[p];
      // Islands at the border of the volume may continue beyond it, and others touch the interface in
      // corners.
      if ((at.array() > 4).all() && (at.array() < 16).all()) EXPECT_NEAR(at[0], 9.5, 3.6);
    }
}

TEST(ImageMesher, SmoothingKeepsVolumes) {
  Random random(5);
  const Vec3 centre(15.5, 15.5, 15.5);
  const ImageVolume image = image_of(
      {32, 32, 32}, {[&](const Vec3& p) { return 10 - (p - centre).norm() + 4 * random.uniform() - 2; }});
  ImageChoice choice = above(0);
  const LabelInput rough = input_of(image, choice);
  choice.smoothing = 1.5;
  const LabelInput smooth = input_of(image, choice);
  EXPECT_NEAR(static_cast<double>(smooth.materials[0].voxels_in_file),
              static_cast<double>(rough.materials[0].voxels_in_file), 2);
  const Function distance = [&](const Vec3& p) { return (p - centre).norm() - 10; };
  const double before = misses(checked_mesh(rough, 1.0).mesh, distance).rms,
               after = misses(checked_mesh(smooth, 1.0).mesh, distance).rms;
  EXPECT_LT(after, before / 3);
}

TEST(ImageMesher, SmoothedChannelsKeepVolumes) {
  Random random(6);
  const Vec3 a(8.2, 9.7, 10.1), b(16.4, 10.3, 9.8);
  const auto near = [&](const Vec3& centre, double radius) {
    return [&, centre, radius](const Vec3& p) {
      return std::clamp(0.5 + 0.2 * (radius - (p - centre).norm()) + 0.2 * random.uniform() - 0.1, 0.0, 1.0);
    };
  };
  const ImageVolume image = image_of({25, 20, 20}, {near(a, 6), near(b, 3)});
  ImageChoice choice;
  choice.names = {"a", "b"};
  choice.min_voxels = 0;
  const LabelInput rough = input_of(image, choice);
  choice.smoothing = 2;
  const LabelInput smooth = input_of(image, choice);
  for (const std::size_t m : {0u, 1u})
    EXPECT_NEAR(static_cast<double>(smooth.materials[m].voxels),
                static_cast<double>(rough.materials[m].voxels),
                2 + 0.002 * static_cast<double>(rough.materials[m].voxels));
}

TEST(ImageMesher, TheSameForAnyNumberOfThreads) {
  Random random(8);
  const ImageVolume image = image_of(
      {26, 25, 27}, {[&](const Vec3& p) { return 9 - (p - Vec3(12, 13, 12)).norm() + random.uniform(); }});
  ImageChoice choice;
  choice.isos = {{"body", std::nullopt}, {"core", 5.0}};
  choice.smoothing = 0.7;
  std::vector<TetMesh> meshes;
  for (const unsigned threads : {1u, 3u}) {
    const ThreadLimit limit(threads);
    meshes.push_back(checked_mesh(input_of(image, choice), 0.8).mesh);
  }
  EXPECT_EQ(meshes[0].points, meshes[1].points);
  EXPECT_EQ(meshes[0].tets, meshes[1].tets);
  EXPECT_EQ(meshes[0].materials, meshes[1].materials);
}

TEST(ImageMesher, SlicesAndTurnedMirroredGrids) {
  // The volume of a ball whose grid is mirrored and has voxels that are no cubes.
  ImageVolume image = image_of({24, 20, 16}, {[](const Vec3& p) {
                                 const Vec3 at(p[0], 1.2 * p[1], 1.5 * p[2]);
                                 return 8 - (at - Vec3(11.6, 11.5, 11.2)).norm();
                               }});
  image.directions =
      Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized()).toRotationMatrix() * Vec3(1, 1.2, -1.5).asDiagonal();
  const LabelInput input = input_of(image, above(0));
  const double ball = 4.0 / 3 * std::numbers::pi * 8 * 8 * 8;
  ASSERT_TRUE(input.materials[0].image_volume.has_value());
  EXPECT_NEAR(*input.materials[0].image_volume * 1.2 * 1.5, ball, 0.015 * ball);
  EXPECT_NEAR(volume_of(checked_mesh(input, 0.8).mesh, 1), ball, 0.025 * ball);
  const ImageVolume slice =
      image_of({20, 20, 1}, {[](const Vec3& p) { return 6 - std::hypot(p[0] - 9.5, p[1] - 9.5); }});
  EXPECT_NEAR(volume_of(checked_mesh(input_of(slice, above(0)), 0.5).mesh, 1), std::numbers::pi * 36, 3);
}

TEST(ImageMesher, LittleSmoothingChangesLittle) {
  const ImageVolume image =
      image_of({16, 16, 16}, {[](const Vec3& p) { return 6 - (p - Vec3(7, 8, 7.5)).norm(); }});
  const double exact = *input_of(image, above(0)).materials[0].image_volume;
  for (const double deviation : {0.001, 0.01, 0.05, 0.2}) {
    ImageChoice choice = above(0);
    choice.smoothing = deviation;
    EXPECT_NEAR(*input_of(image, choice).materials[0].image_volume, exact, 0.03 * exact) << deviation;
  }
}

TEST(ImageMesher, ALostBandBelongsToTheOneBelow) {
  // The edge is so sharp that no voxel is in the band between.
  const ImageVolume image = image_of({20, 20, 20}, {[](const Vec3& p) { return p[0] < 9.5 ? 1000.0 : 0.0; }});
  ImageChoice choice;
  choice.isos = {{"flesh", 100.0}, {"bone", 600.0}};
  const LabelInput input = input_of(image, choice);
  ASSERT_EQ(input.materials.size(), 1u);
  EXPECT_EQ(input.materials[0].name, "bone");
  // The bone ends at 9 + 0.4, where the value is 600.
  const double volume = 400 * 9.9;
  EXPECT_NEAR(*input.materials[0].image_volume, volume, 0.03 * volume);
  EXPECT_NEAR(volume_of(checked_mesh(input, 1.0).mesh, 2), volume, 0.01 * volume);
}

TEST(ImageMesher, SharpMapsOfManyChannelsTakeLittleMemory) {
  // Cells of 3^3 seeds, each with a map of 0 and 1.
  constexpr int seeds = 27;
  std::vector<Function> maps;
  for (int s = 0; s < seeds; ++s)
    maps.emplace_back([s](const Vec3& p) {
      const auto cell = [](double x) { return std::min(2, static_cast<int>(x / 8)); };
      return cell(p[0]) + 3 * cell(p[1]) + 9 * cell(p[2]) == s ? 1.0 : 0.0;
    });
  ImageChoice choice;
  for (int s = 0; s < seeds; ++s) choice.names.push_back("m" + std::to_string(s));
  const LabelInput input = input_of(image_of({24, 24, 24}, maps), choice);
  const LabelBricks bricks = make_image_bricks(input, nullptr);
  // At most eight meet near a brick.
  EXPECT_LE(bricks.channels.size(), 8 * bricks.bricks.size());
  EXPECT_EQ(checked_mesh(input, 1.0).mesh.material_names.size(), 27u);
}

TEST(ImageMesher, ContrastOfAnotherMaterialNearbyDoesNotMoveAnInterface) {
  // Metal of a contrast of 40 times that of the bone, eight voxels away.
  const ImageVolume image = image_of({30, 16, 16}, {[](const Vec3& p) {
                                       const double bone = 100 * std::clamp(p[0] - 9.3, -1.0, 1.0);
                                       const double metal = 4000 * std::clamp(p[0] - 19.3, 0.0, 1.0);
                                       return bone + metal;
                                     }});
  ImageChoice choice;
  choice.isos = {{"bone", 20.0}, {"metal", 2100.0}};
  const DenseMesh made = checked_mesh(input_of(image, choice), cells_of(1, 0));
  const Misses found = misses(
      made.mesh, [&](const Vec3& p) { return std::min(std::abs(p[0] - 9.5), std::abs(p[0] - 19.714)); });
  EXPECT_LT(found.rms, 0.04);
}

TEST(ImageMesher, ValuesThatAreMissingOrNotFiniteAreRefused) {
  ImageVolume image = image_of({4, 4, 4}, {[](const Vec3& p) { return p[0]; }});
  image.channels[0][5] = std::nanf("");
  EXPECT_THROW(input_of(image, above(1)), InputError);
  image.channels[0].pop_back();
  EXPECT_THROW(input_of(image, above(1)), InputError);
  image.channels.clear();
  EXPECT_THROW(input_of(image, above(1)), InputError);
}

TEST(ImageMesher, OtsuDividesTwoClasses) {
  Random random(7);
  std::vector<float> values;
  for (int i = 0; i < 3000; ++i) values.push_back(static_cast<float>(10 + random.uniform()));
  for (int i = 0; i < 1000; ++i) values.push_back(static_cast<float>(30 + 2 * random.uniform()));
  const double threshold = otsu_threshold(values);
  EXPECT_GT(threshold, 11);
  EXPECT_LT(threshold, 30);
  // In the middle of what separates them equally well.
  EXPECT_NEAR(threshold, 20.5, 0.1);
}

TEST(ImageMesher, ThresholdsThatDoNotDivideTheImageAreRefusedWithItsRange) {
  const ImageVolume image = image_of({4, 4, 4}, {[](const Vec3& p) { return p[0]; }});
  const auto message = [&](const ImageChoice& choice) -> std::string {
    try {
      (void)input_of(image, choice);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(message(above(5)).find("from 0 to 3"), std::string::npos) << message(above(5));
  EXPECT_THROW(input_of(image, above(5)), NothingToMeshError);
  EXPECT_NE(message(above(-1)).find("no value is below -1"), std::string::npos) << message(above(-1));
  ImageChoice twice;
  twice.isos = {{"a", 1.0}, {"b", 1.0}};
  EXPECT_THROW(input_of(image, twice), UsageError);
  twice.isos = {{"a", 1.0}, {"a", 2.0}};
  EXPECT_THROW(input_of(image, twice), UsageError);
  twice.isos = {{"outside", 1.0}};
  EXPECT_THROW(input_of(image, twice), UsageError);
}

}  // namespace
}  // namespace tetwright::image_mesher_test

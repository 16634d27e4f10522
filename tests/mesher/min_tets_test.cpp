// SPDX-License-Identifier: Apache-2.0

// The smallest number of tets, from volumes and areas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesher/tuning/estimate_tuning.h"
#include "tests/mesher/fields.h"
#include "tests/mesher/label_volumes.h"
#include "tetwright/mesher.h"

namespace tetwright::min_tets_test {
namespace {

using Filling = EstimateTuning::Filling;

MinTets only(const std::vector<MinTets>& needs) {
  EXPECT_EQ(needs.size(), 1u);
  return needs.at(0);
}

TEST(MinTets, CompactBodiesTakeHardlyAny) {
  EXPECT_NEAR(only(min_tets(make_input({make_sphere(3)}))).tets, Filling::per_surface_part, 1e-9);
  EXPECT_LT(only(min_tets(make_input({make_box(Vec3::Zero(), Vec3::Ones())}))).tets,
            2 * Filling::per_surface_part);
}

TEST(MinTets, PlateTakesTetsByTheSquareOfItsThickness) {
  const auto plate = [](double thickness) {
    return only(min_tets(make_input({make_box(Vec3::Zero(), Vec3(100, 100, thickness))})));
  };
  const double wall = 8 * 10000 / Filling::surface_per_tet;  // (2 S)^3 / (S t)^2
  EXPECT_NEAR(plate(1).tets, wall, 0.1 * wall);
  EXPECT_NEAR(plate(0.5).tets, 4 * wall, 0.1 * 4 * wall);
  EXPECT_NEAR(plate(0.5).thickness, 0.5, 0.02);
}

TEST(MinTets, UnitsDoNotMatter) {
  const double one = only(min_tets(make_input({make_box(Vec3::Zero(), Vec3(9, 9, 0.2))}))).tets,
               large = only(min_tets(make_input({make_box(Vec3::Zero(), 1000 * Vec3(9, 9, 0.2))}))).tets;
  EXPECT_NEAR(large, one, 1e-6 * one);
}

TEST(MinTets, ThinShellBetweenNestedBodiesIsNamed) {
  const std::vector<MinTets> needs =
      min_tets(make_input({make_sphere(10, Vec3::Zero(), 5), make_sphere(9.5, Vec3::Zero(), 5)}));
  ASSERT_EQ(needs.size(), 2u);
  EXPECT_EQ(needs[0].name, "m1");
  EXPECT_NEAR(needs[0].thickness, 0.5, 0.02);
  EXPECT_GT(needs[0].tets, 1000);
  EXPECT_LT(needs[1].tets, 2 * Filling::per_surface_part);
}

TEST(MinTets, LayersTakeAsManyAsTheShellsThatTheyAre) {
  const TriangleMesh ball = make_sphere(10, Vec3::Zero(), 5);
  const std::vector<MinTets> layers = min_tets(make_input({ball}, {0.5})),
                             shells = min_tets(make_input({ball, make_sphere(9.5, Vec3::Zero(), 5)}));
  const auto layer = std::find_if(layers.begin(), layers.end(), [](const auto& m) { return m.name == "l1"; });
  ASSERT_NE(layer, layers.end());
  EXPECT_NEAR(layer->tets, shells[0].tets, 0.03 * shells[0].tets);
  EXPECT_NEAR(layer->thickness, 0.5, 0.02);
}

TEST(MinTets, LayersLieBelowTheFirstSurfaceAlone) {
  const TriangleMesh ball = make_sphere(10, Vec3::Zero(), 5);
  std::vector<TriangleMesh> with_inner{ball};
  for (const double x : {-4, 4})
    for (const double y : {-4, 4}) with_inner.push_back(make_sphere(2, Vec3(x, y, 0), 4));
  const auto layer_of = [](const std::vector<MinTets>& needs) {
    return std::find_if(needs.begin(), needs.end(), [](const auto& m) { return m.name == "l1"; })->tets;
  };
  const double alone = layer_of(min_tets(make_input({ball}, {0.5})));
  EXPECT_NEAR(layer_of(min_tets(make_input(with_inner, {0.5}))), alone, 1e-6 * alone);
}

TEST(MinTets, LabelsThatBodiesCoverTakeNone) {
  // A thin disc in a block.
  LabelInput labels = make_labels({30, 30, 12}, [](int x, int y, int z) {
    return z == 6 && (Vec3(x, y, 6) - Vec3(15, 15, 6)).norm() < 11 ? 2 : 1;
  });
  const auto names_with = [&](const TriangleMesh& body) {
    MaterialSurface surface{"implant", 9, body, "implant.stl"};
    std::vector<std::string> names;
    for (const MinTets& m : min_tets(make_implanted_volume(labels, make_mesher_input({surface}))))
      names.push_back(m.name);
    return names;
  };
  EXPECT_EQ(names_with(make_box(Vec3(3, 3, 5), Vec3(27, 27, 7))),
            (std::vector<std::string>{"label_1", "implant"}));
  EXPECT_EQ(names_with(make_box(Vec3(3, 3, 1), Vec3(27, 27, 4))),
            (std::vector<std::string>{"label_1", "label_2", "implant"}));
}

TEST(MinTets, VolumesTakeAsManyAsSurfaces) {
  // A shell between radii of 20 and 17 voxels around a ball.
  const std::vector<MinTets> labels = min_tets(make_labels({44, 44, 44}, [](int x, int y, int z) {
    const double r = (Vec3(x, y, z) - Vec3::Constant(21.5)).norm();
    return r < 17 ? 2 : r < 20 ? 1 : 0;
  }));
  const std::vector<MinTets> surfaces =
      min_tets(make_input({make_sphere(20, Vec3::Zero(), 5), make_sphere(17, Vec3::Zero(), 5)}));
  ASSERT_EQ(labels.size(), 2u);
  const double slenderness = (surfaces[0].tets - 2 * Filling::per_surface_part) * Filling::surface_per_tet;
  EXPECT_NEAR((labels[0].tets - 2 * Filling::per_closed_interface) * Filling::label_per_tet, slenderness,
              0.15 * slenderness);
  EXPECT_NEAR(labels[0].thickness, surfaces[0].thickness, 0.05 * labels[0].thickness);
}

TEST(MinTets, ObliqueSheetsOfOneVoxelTakeMoreThanFlatOnes) {
  const MinTets flat = only(min_tets(make_labels({46, 46, 9}, [](int x, int y, int z) {
    return z == 4 && x > 2 && x < 43 && y > 2 && y < 43 ? 1 : 0;
  })));
  const MinTets shell = min_tets(make_labels({40, 40, 40}, [](int x, int y, int z) {
    const double r = (Vec3(x, y, z) - Vec3::Constant(19.5)).norm();
    return r < 17 ? 2 : r < 18 ? 1 : 0;
  }))[0];
  const auto by_area = [](const MinTets& m, double area) {
    return m.tets * m.thickness * m.thickness / area;
  };
  EXPECT_GT(by_area(shell, 4 * 3.14 * 17.5 * 17.5), 1.5 * by_area(flat, 40 * 40));
}

}  // namespace
}  // namespace tetwright::min_tets_test

// SPDX-License-Identifier: Apache-2.0
#include "tetwright/value_bins.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/samples/samples.h"
#include "tests/common/small_meshes.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Separate tets of volumes 1/6, 2/6, 3/6 and so on.
TetMesh tets_of(const std::vector<MaterialTag>& materials) {
  TetMesh mesh;
  for (std::size_t t = 0; t < materials.size(); ++t) {
    const auto first = static_cast<Index>(4 * t);
    const double x = 10 * static_cast<double>(t);
    for (const Vec3& p :
         {Vec3(x, 0, 0), Vec3(x + static_cast<double>(t) + 1, 0, 0), Vec3(x, 1, 0), Vec3(x, 0, 1)})
      mesh.points.push_back(p);
    mesh.tets.push_back({first, first + 1, first + 2, first + 3});
  }
  mesh.materials = materials;
  return mesh;
}

}  // namespace

TEST(ValueBins, EachMaterialHasBinsOfEqualWidthBetweenItsOwnValues) {
  TetMesh mesh = tets_of({1, 1, 1, 1, 2, 2});
  mesh.material_names = {{1, "bone"}};
  const TetBins bins = bin_tets(mesh, "density", {0, 10, 29.9, 30, 500, 1000}, {.count = 3});
  ASSERT_EQ(bins.bins.size(), 5u);
  EXPECT_EQ(bins.bins[0].name, "bone_001");
  EXPECT_EQ(bins.bins[1].name, "bone_002");  // an inner bound belongs to the bin above
  EXPECT_EQ(bins.bins[2].name, "bone_003");
  EXPECT_EQ(bins.bins[3].name, "material_2_001");
  EXPECT_EQ(bins.bins[4].name, "material_2_003");  // the second one has no tets
  EXPECT_EQ(bins.of_tets, (std::vector<std::uint32_t>{0, 1, 2, 2, 3, 4}));
  EXPECT_EQ(bins.bins[2].tets, 2u);
  EXPECT_NEAR(bins.bins[2].volume, 7.0 / 6, 1e-14);
  EXPECT_NEAR(bins.bins[2].mean, (3 * 29.9 + 4 * 30) / 7, 1e-12);
  EXPECT_EQ(bins.bins[2].low, 20);
  EXPECT_EQ(bins.bins[2].high, 30);
  const MeshField field = field_of_bins(bins);
  EXPECT_EQ(field.name, "density_bin");
  EXPECT_TRUE(field.integer);
  EXPECT_EQ(field.values, (std::vector<double>{1, 2, 3, 3, 1, 3}));
}

TEST(ValueBins, EdgesAreTheSameForAllMaterialsAndTheOuterBinsAreOpen) {
  const TetMesh mesh = tets_of({1, 1, 2, 2});
  const TetBins bins = bin_tets(mesh, "hu", {-500, 100, 300, 301}, {.edges = {100, 300}});
  ASSERT_EQ(bins.bins.size(), 3u);
  EXPECT_EQ(bins.bins[0].number, 1u);
  EXPECT_EQ(bins.bins[0].low, -HUGE_VAL);
  EXPECT_EQ(bins.bins[1].number, 2u);
  EXPECT_EQ(bins.bins[2].number, 3u);
  EXPECT_EQ(bins.bins[2].tets, 2u);
  EXPECT_EQ(bins.bins[2].high, HUGE_VAL);
}

TEST(ValueBins, EqualValuesAreInOneBinAndNamesAreUnique) {
  TetMesh mesh = tets_of({1, 2});
  mesh.material_names = {{1, "bone"}, {2, "bone_001"}};
  const TetBins bins = bin_tets(mesh, "d", {5, 5}, {.count = 4});
  ASSERT_EQ(bins.bins.size(), 2u);
  EXPECT_EQ(bins.bins[0].mean, 5);
  EXPECT_NE(bins.bins[0].name, "bone_001");  // a material's name
}

TEST(ValueBins, TheModulusFollowsThePowerLawOfTheCalibratedMean) {
  const TetMesh mesh = tets_of({1, 1, 1});
  TetBins bins = bin_tets(mesh, "hu", {-1000, 200, 1200}, {.edges = {0, 1000}});
  const ModulusLaw law{.factor = 6850, .exponent = 1.49, .scale = 0.001, .offset = 0.1, .minimum = 5};
  set_moduli(law, bins);
  EXPECT_EQ(bins.bins[0].modulus, 5);  // below 0 after calibration
  EXPECT_NEAR(*bins.bins[1].modulus, 6850 * std::pow(0.3, 1.49), 1e-6);
  EXPECT_NEAR(*bins.bins[2].modulus, 6850 * std::pow(1.3, 1.49), 1e-6);
  EXPECT_EQ(bins.poisson, 0.3);
  try {
    set_moduli({.factor = 6850, .exponent = 1.49, .scale = 0.001, .offset = 0.1}, bins);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("material_1_001"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("--min-modulus"), std::string::npos);
  }
}

TEST(ValueBins, TheTableHasALineForEachBin) {
  TetMesh mesh = tets_of({1, 1});
  mesh.material_names = {{1, "bone, left"}};
  TetBins bins = bin_tets(mesh, "d", {1, 3}, {.edges = {2}});
  EXPECT_EQ(table_of_bins(mesh, {&bins, 1}),
            "name,material,bin,low,high,tets,volume,mean\n"
            "\"bone, left_001\",\"bone, left\",1,,2,1,0.16666666666666666,1\n"
            "\"bone, left_002\",\"bone, left\",2,2,,1,0.3333333333333333,3\n");
  set_moduli({.factor = 10, .exponent = 1}, bins);
  EXPECT_NE(table_of_bins(mesh, {&bins, 1}).find(",3,30,0.3\n"), std::string::npos);
}

TEST(ValueBins, OfSeveralDivisionsHaveNamesOfTheirOwn) {
  TetMesh mesh = tets_of({1, 1});
  mesh.material_names = {{1, "bone"}};
  std::vector<TetBins> both = {bin_tets(mesh, "hu", {1, 3}, {.edges = {2}}),
                               bin_tets(mesh, "t2", {5, 5}, {.count = 3})};
  name_apart(mesh, std::span(both).first(1));
  EXPECT_EQ(both[0].bins[0].name, "bone_001");
  name_apart(mesh, both);
  EXPECT_EQ(both[0].bins[1].name, "bone_hu_002");
  EXPECT_EQ(both[1].bins[0].name, "bone_t2_001");
  EXPECT_EQ(leading_division(both), 0u);
  set_moduli({.factor = 10, .exponent = 1}, both[1]);
  EXPECT_EQ(leading_division(both), 1u);
  const std::string table = table_of_bins(mesh, both);
  EXPECT_EQ(table.rfind("name,values,material,bin,low,high,tets,volume,mean,modulus,poisson\n"
                        "bone_hu_001,hu,bone,1,,2,1,0.16666666666666666,1,,\n",
                        0),
            0u)
      << table;
  EXPECT_NE(table.find("bone_t2_001,t2,bone,1,5,5,2,0.5,5,50,0.3\n"), std::string::npos) << table;
}

}  // namespace tetwright

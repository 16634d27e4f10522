// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/usd.h"

#include <gtest/gtest.h>

#include "tests/common/io/expect_error.h"
#include "tests/common/io/round_trip.h"

namespace tetwright::usd_test {
namespace {

TEST(Usd, MaterialsAndBoundaryAreSubsets) {
  TetMesh mesh = mesh_with_surfaces();
  mesh.material_names[1] = "a \"b\"\\c";
  mesh.material_names[-7] = "outlet";  // as a patch is called
  const std::string text = text_of(write_usd, mesh);
  const std::string tetrahedra = "\n    {\n        uniform token elementType = \"tetrahedron\"\n",
                    faces = "\n    {\n        uniform token elementType = \"face\"\n";
  for (const std::string& part : std::vector<std::string>{
           "#usda 1.0\n", "def TetMesh \"mesh\"\n{\n    float3[] extent = [(0, 0, -1), (0.33333334, 1, 1)]\n",
           "(0.33333334, 1e-07, -0.6666667)", "int4[] tetVertexIndices = [(0, 1, 2, 3), (0, 2, 1, 4)]\n",
           "def GeomSubset \"a__b__c\"" + tetrahedra +
               "        uniform token familyName = \"materialBind\"\n        int[] indices = [0]\n",
           R"(        custom string tetwright:name = "a \"b\"\\c")",
           "        custom int64 tetwright:number = 1\n", "def GeomSubset \"outlet\"" + tetrahedra,
           "def GeomSubset \"outlet_2\"" + faces + "        uniform token familyName = \"boundary\"\n",
           R"(custom string tetwright:name = "outlet|outside")",
           R"(subsetFamily:materialBind:familyType = "partition")",
           R"(uniform token orientation = "rightHanded")"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  // The contact of both materials is no surface.
  EXPECT_EQ(text.find("outlet|a"), std::string::npos) << text;
}

TEST(Usd, BeyondSinglePrecision) {
  TetMesh mesh = one_tet();
  mesh.points[1].x() = 1e39;
  const std::string message = error_of<InputError>([&] { (void)text_of(write_usd, mesh); });
  EXPECT_NE(message.find("(1e+39, 0, 0)"), std::string::npos) << message;
}

TEST(Usd, LossesOfSinglePrecisionAreFoundExactly) {
  const auto at = [](double x) {
    TetMesh mesh = one_tet();
    for (Vec3& p : mesh.points) p.x() += x;
    return single_precision_loss(mesh);
  };
  // Beyond 2^24 floats are 2 apart; 1 is rounded to the even neighbour.
  EXPECT_EQ(at(0x1p24 - 2).tets, 0u);
  EXPECT_EQ(at(0x1p24).tets, 1u);
  EXPECT_EQ(at(0x1p24).points, 1u);
  EXPECT_NEAR(at(0x1p24).first.x(), 0x1p24 + 0.25, 1e-6);
  EXPECT_EQ(at(0x1p24 + 2).tets, 0u);
  TetMesh turned = one_tet();
  turned.points[3] = {0.25, 0.25, 1 + 1e-9};
  turned.points[0].z() = turned.points[1].z() = turned.points[2].z() = 1;
  EXPECT_EQ(single_precision_loss(turned).tets, 1u);
  EXPECT_EQ(single_precision_loss(turned).points, 0u);
  // Negative and flat tets, and equal points of the mesh, are not due to it.
  turned = two_tets();
  std::swap(turned.tets[0][0], turned.tets[0][1]);
  turned.points.push_back(turned.points[0]);
  EXPECT_EQ(single_precision_loss(turned).tets, 0u);
  EXPECT_EQ(single_precision_loss(turned).points, 0u);
}

}  // namespace
}  // namespace tetwright::usd_test

// SPDX-License-Identifier: Apache-2.0

// Tests how formats hold bins of tets.
#include <gtest/gtest.h>

#include "common/io/tets/abaqus.h"
#include "common/io/tets/febio.h"
#include "common/io/tets/msh.h"
#include "common/io/tets/nastran.h"
#include "tests/common/io/round_trip.h"

namespace tetwright::bins_test {
namespace {

/// A mesh of two tets of the same material and one of another, with bins of the first ones.
struct Binned {
  explicit Binned(bool moduli = false) {
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {0, 0, -1}};
    mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}, {0, 2, 1, 5}};
    mesh.materials = {7, 7, 9};
    mesh.material_names = {{7, "bone"}, {9, "plate"}};
    mesh.interfaces = find_interfaces(mesh);
    bins = bin_tets(mesh, "density", {1, 2, 5}, {.count = 2});
    if (moduli) set_moduli({.factor = 1000, .exponent = 1}, bins);
  }
  MeshToWrite written() const { return {mesh, nullptr, &bins}; }

  TetMesh mesh;
  TetBins bins;
};

void expect_parts(const std::string& text, std::initializer_list<const char*> parts) {
  for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(Bins, AbaqusHasElementSetsBesideTheMaterials) {
  const Binned binned;
  const std::string text = text_of(write_abaqus, binned.written());
  expect_parts(
      text, {"*ELEMENT, TYPE=C3D4, ELSET=bone\n1, 1, 2, 3, 4\n2, 2, 3, 4, 5\n", "*ELSET, ELSET=bone_001\n1\n",
             "*ELSET, ELSET=bone_002\n2\n", "*ELSET, ELSET=plate_001\n3\n",
             "** bone_002: mean 2 of density, from 1.5 to 2, 1 tet\n"});
  EXPECT_EQ(text.find("*ELASTIC"), std::string::npos);
  // The materials and surfaces are those of the mesh.
  const ReadTetMesh read = read_abaqus(text, "a.inp");
  EXPECT_EQ(read.mesh.materials, binned.mesh.materials);
  EXPECT_EQ(text.find("bone_001_"), std::string::npos);  // no surface between bins
}

TEST(Bins, AbaqusHasASectionForEachModulus) {
  const Binned binned(true);
  const std::string text = text_of(write_abaqus, binned.written());
  expect_parts(text, {"*MATERIAL, NAME=bone_001\n*ELASTIC\n1000.0, 0.3\n*SOLID SECTION, ELSET=bone_001, "
                      "MATERIAL=bone_001\n",
                      "*MATERIAL, NAME=plate_001\n*ELASTIC\n5000.0, 0.3\n"});
  EXPECT_EQ(read_abaqus(text, "a.inp").mesh.materials.size(), 3u);
}

TEST(Bins, NastranHasAPropertyForEachBin) {
  const Binned binned(true);
  const std::string text = text_of(write_nastran, binned.written());
  expect_parts(
      text, {"$ material 10: bone_001\nPSOLID  10      10\n", "$ material 11: bone_002\nPSOLID  11      11\n",
             "$ material 12: plate_001\n", "MAT1*   10              1000.0          "});
  const ReadTetMesh read = read_nastran(text, "a.bdf");
  EXPECT_EQ(read.mesh.materials, (std::vector<MaterialTag>{10, 11, 12}));
  EXPECT_EQ(read.mesh.material_names.at(11), "bone_002");
  // The faces between bins of a material are no surface.
  EXPECT_NE(text.find(": plate|outside\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("bone_001|"), std::string::npos);
}

TEST(Bins, FebioHasADomainAndAMaterialForEachBin) {
  const std::string text = text_of(write_febio, Binned(true).written());
  expect_parts(
      text,
      {"<material id=\"2\" name=\"bone_002\" type=\"isotropic elastic\"><E>2000</E><v>0.3</v></material>",
       "<Elements type=\"tet4\" name=\"bone_001\">\n<elem id=\"1\">",
       "<SolidDomain name=\"plate_001\" mat=\"plate_001\"/>", "<Surface name=\"bone|plate\">"});
  EXPECT_LT(text.find("</Material>"), text.find("<Mesh>"));
}

TEST(Bins, Msh22HasAGroupForEachBin) {
  const Binned binned;
  const std::string text = write_msh(binned.written());
  expect_parts(
      text, {"3 10 \"bone_001\"\n", "3 11 \"bone_002\"\n", "3 12 \"plate_001\"\n", "2 2 \"bone|plate\"\n"});
  const ReadTetMesh read = read_msh(text, "a.msh");
  EXPECT_EQ(read.mesh.materials, (std::vector<MaterialTag>{10, 11, 12}));
}

TEST(Bins, Msh41HasVolumesInGroupsOfTheMaterialAndOfTheBin) {
  const Binned binned;
  for (const auto& write : {write_msh41, write_msh41_binary}) {
    const std::string text = text_of(write, binned.written());
    expect_parts(text, {"3 7 \"bone\"\n", "3 10 \"bone_001\"\n", "3 12 \"plate_001\"\n"});
    const ReadTetMesh read = read_msh(text, "a.msh");
    EXPECT_EQ(read.mesh.materials, (std::vector<MaterialTag>{7, 7, 9}));
    EXPECT_EQ(read.mesh.material_names.at(7), "bone");
  }
}

}  // namespace
}  // namespace tetwright::bins_test

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
  MeshToWrite written() const { return {mesh, nullptr, {&bins, 1}}; }

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

/// Binned, and a second division: {1, 3} and {2} in the bins, with moduli.
struct TwiceBinned : Binned {
  TwiceBinned() {
    TetBins second = bin_tets(mesh, "ash", {1, 9, 1}, {.edges = {5}});
    divisions = {bins, second};
    name_apart(mesh, divisions);
    set_moduli({.factor = 1000, .exponent = 1}, divisions[1]);
  }
  MeshToWrite written() const { return {mesh, nullptr, divisions}; }

  std::vector<TetBins> divisions;
};

TEST(Bins, OfSeveralValuesAreSetsOfTheirOwn) {
  const TwiceBinned binned;
  const std::string abaqus = text_of(write_abaqus, binned.written());
  expect_parts(abaqus, {"*ELSET, ELSET=bone_density_001\n1\n", "*ELSET, ELSET=bone_density_002\n2\n",
                        "*ELSET, ELSET=bone_ash_002\n2\n", "*ELSET, ELSET=plate_ash_001\n3\n",
                        "*SOLID SECTION, ELSET=plate_ash_001, MATERIAL=plate_ash_001\n"});
  EXPECT_EQ(abaqus.find("MATERIAL=bone_density"), std::string::npos) << abaqus;
  // Sections are materials when the file is read.
  EXPECT_EQ(read_abaqus(abaqus, "a.inp").mesh.material_names.at(2), "bone_ash_002");
}

TEST(Bins, WithModuliArePropertiesAndOthersSets) {
  const TwiceBinned binned;
  const std::string nastran = text_of(write_nastran, binned.written());
  expect_parts(nastran, {"$ material 10: bone_ash_001\nPSOLID  10      10\n", "MAT1*   10",
                         ": bone_density_002, tets with the mean 2 of density"});
  // The numbers of sets of tets follow those of the surfaces' sets of nodes.
  const std::size_t set = nastran.find(": plate_density_001, tets");
  ASSERT_NE(set, std::string::npos) << nastran;
  EXPECT_NE(nastran.find("3\n", nastran.find("SET1", set)), std::string::npos);
  EXPECT_EQ(read_nastran(nastran, "a.bdf").mesh.material_names.at(11), "bone_ash_002");
  const std::string febio = text_of(write_febio, binned.written());
  expect_parts(febio, {"<Elements type=\"tet4\" name=\"bone_ash_001\">",
                       "<ElementSet name=\"bone_density_002\">2</ElementSet>",
                       "<ElementSet name=\"plate_density_001\">3</ElementSet>"});
  const ReadTetMesh msh = read_msh(write_msh(binned.written()), "a.msh");
  EXPECT_EQ(msh.mesh.material_names.at(11), "bone_ash_002");
}

TEST(Bins, OfSeveralValuesAreGroupsOfTheirCombinationsInMsh41) {
  const TwiceBinned binned;
  for (const auto& write : {write_msh41, write_msh41_binary}) {
    const std::string text = text_of(write, binned.written());
    expect_parts(text, {"\"bone_ash_002\"", "\"bone_density_001\"", "\"plate_density_001\""});
    EXPECT_EQ(read_msh(text, "a.msh").mesh.materials, (std::vector<MaterialTag>{7, 7, 9}));
  }
  // Each volume is in the groups of its material and of both bins.
  const std::string text = text_of(write_msh41, binned.written());
  expect_parts(text, {" 3 7 10 13 ", " 3 7 11 14 ", " 3 9 12 15 "});
}

}  // namespace
}  // namespace tetwright::bins_test

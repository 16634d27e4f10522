// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/abaqus_assembly.h"

#include <algorithm>

#include "common/io/tets/abaqus.h"
#include "tests/common/io/expect_error.h"
#include "tests/common/io/tricky_meshes.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::abaqus_assembly_test {
namespace {

/// Two parts whose nodes and elements have the same numbers.
const std::string parts =
    "*Heading\n*Part, name=Pin\n*Node\n1, 0.1, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n10, 0., 0., 1.e0\n"
    "*Element, type=C3D4\n7, 1, 2, 3, 10\n*Elset, elset=All, generate\n7, 7, 1\n"
    "*Surface, type=ELEMENT, name=Foot\nAll, S1\n*Solid Section, elset=All, material=Steel\n,\n*End Part\n"
    "*Part, name=Block\n*Node\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n10, 0, 0, 1\n11, 0, 0, -1\n"
    "*Element, type=C3D4, elset=Up\n7, 1, 2, 3, 10\n*Element, type=C3D4, elset=Down\n8, 1, 3, 2, 11\n*End "
    "Part\n"
    "*Part, name=Spare\n*Node\n1, 0, 0, 0\n*End Part\n";

std::string assembly(const std::string& instances, const std::string& more = "") {
  return parts + "*Assembly, name=A\n" + instances + more + "*End Assembly\n*Material, name=Steel\n";
}

std::string instance(const std::string& name, const std::string& part, const std::string& lines = "") {
  return "*Instance, name=" + name + ", part=" + part + "\n" + lines + "*End Instance\n";
}

ReadTetMesh read(const std::string& text) { return read_abaqus(text, "f"); }

TEST(AbaqusAssembly, InstancesArePlacedAndNamed) {
  const ReadTetMesh r =
      read(assembly(instance("Pin-1", "pin") + instance("Block-1", "BLOCK", "10, 0, 0.5\n") +
                    instance("Pin-2", "PIN", "0, 0, 0\n1, 0, 0, 1, 0, 5, 90\n")));
  // Each has nodes of its own, in the order of the instances.
  EXPECT_EQ(r.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}, {4, 5, 6, 7}, {4, 6, 5, 8}, {9, 10, 11, 12}}));
  ASSERT_EQ(r.mesh.points.size(), 13u);
  EXPECT_EQ(r.mesh.points[0], Vec3(0.1, 0, 0));
  EXPECT_EQ(r.mesh.points[8], Vec3(10, 0, -0.5));
  // A quarter around the line x = 1, y = 0 turns (0, 1) into (0, -1).
  EXPECT_EQ(r.mesh.points[10], Vec3(1, 0, 0));
  EXPECT_EQ(r.mesh.points[11], Vec3(0, -1, 0));
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{1, 2, 3, 4}));
  EXPECT_EQ(r.mesh.material_names, (std::map<MaterialTag, std::string>{
                                       {1, "Pin-1"}, {2, "Block-1.Up"}, {3, "Block-1.Down"}, {4, "Pin-2"}}));
  EXPECT_EQ(r.material_field, "SOLID SECTION");
  EXPECT_EQ(r.mesh.patch_groups,
            (std::map<InterfacePatch, SurfaceRegion>{{{{1, std::nullopt}, 1}, {1, "Pin-1.Foot"}},
                                                     {{{4, std::nullopt}, 2}, {2, "Pin-2.Foot"}}}));
  EXPECT_EQ(r.dropped, (std::vector<Dropped>{{"parts without an instance (\"Spare\")", 1}}));
}

TEST(AbaqusAssembly, OneInstanceHasTheNamesOfItsPart) {
  const ReadTetMesh r = read(assembly(instance("Block-1", "Block")));
  EXPECT_EQ(r.mesh.material_names, (std::map<MaterialTag, std::string>{{1, "Up"}, {2, "Down"}}));
  EXPECT_EQ(r.material_field, "ELSET");
}

TEST(AbaqusAssembly, PointsThatAreNotMovedKeepEveryBit) {
  const std::string nodes =
      "*Part, name=P\n*Node\n1, -0., 1e-310, 0.1\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n*Element, type=C3D4\n"
      "1, 1, 2, 3, 4\n*End Part\n*Assembly, name=A\n";
  const auto points = [&](const std::string& lines) {
    return read(nodes + instance("I", "P", lines) + instance("J", "P", "5, 0, 0\n")).mesh.points;
  };
  const Vec3 own(-0.0, 1e-310, 0.1);
  for (const std::string lines : {"", "0, 0, 0\n", "0., 0., 0.\n0, 0, 0, 1, 2, 3, 720\n"}) {
    EXPECT_TRUE(same_bits({points(lines)[0]}, {own})) << lines;
  }
}

TEST(AbaqusAssembly, TranslationComesBeforeRotation) {
  // By Rodrigues' formula for 30 degrees around the line through (1, 2, 3) with the direction (1, 1, 1).
  const AbaqusPlacement placement{
      Vec3(5, 0, 0),
      AbaqusPlacement::Rotation{Vec3(1, 2, 3), Vec3(1, 1, 1).normalized(), std::sqrt(3) / 2, 0.5}};
  const Vec3 moved = placement(Vec3(0, 0, 0));
  const double c = std::sqrt(3) / 2, s = 0.5, k = 1 / std::sqrt(3);
  const Vec3 v(4, -2, -3);
  const Vec3 expected(1 + c * v.x() + s * k * (v.z() - v.y()) + (1 - c) * (v.sum() / 3),
                      2 + c * v.y() + s * k * (v.x() - v.z()) + (1 - c) * (v.sum() / 3),
                      3 + c * v.z() + s * k * (v.y() - v.x()) + (1 - c) * (v.sum() / 3));
  EXPECT_NEAR((moved - expected).norm(), 0, 1e-14);
  const ReadTetMesh r = read(assembly(instance("A", "Pin", "5, 0, 0\n1, 2, 3, 2, 3, 4, 30.\n")));
  EXPECT_NEAR((r.mesh.points[0] - placement(Vec3(0.1, 0, 0))).norm(), 0, 1e-14);
}

TEST(AbaqusAssembly, SetsAndSurfacesOfTheAssembly) {
  const std::string two = instance("P.1", "Pin") + instance("Q", "Pin", "5, 0, 0\n");
  for (const std::string surface :
       {"*Elset, elset=S, instance=Q\n7\n*Surface, name=Load\nS, S2\n",
        "*Elset, elset=S, instance=Q, generate\n7, 7\n*Elset, elset=T\nS\n*Surface, name=Load\nT, S2\n",
        "*Elset, elset=S, instance=q\nall\n*Surface, name=Load\ns, S2\n",
        "*Elset, elset=S\nq.all\n*Surface, name=Load\nS, S2\n", "*Surface, name=Load\nQ.7, S2\n",
        "*Surface, name=Load\nQ.All, S2\n", "*Surface, name=Load, instance=Q\n7, S2\n"}) {
    SCOPED_TRACE(surface);
    const ReadTetMesh r = read(assembly(two, surface));
    EXPECT_EQ(r.mesh.material_names, (std::map<MaterialTag, std::string>{{1, "P.1"}, {2, "Q"}}));
    ASSERT_TRUE(r.mesh.patch_groups.contains({{2, std::nullopt}, 1}));
    EXPECT_EQ(r.mesh.patch_groups.at({{2, std::nullopt}, 1}).name, "Load");
    for (const InterfaceTriangle& t : r.mesh.interfaces)
      if (t.material == 2 && t.patch == 1) {
        EXPECT_TRUE(std::is_permutation(t.ids.begin(), t.ids.end(), std::array<Index, 3>{4, 5, 7}.begin()));
      }
  }
  const ReadTetMesh first = read(assembly(two, "*Surface, name=Load\nP.1.7, S2\n"));
  EXPECT_EQ(first.mesh.patch_groups.at({{1, std::nullopt}, 2}).name, "P.1.Foot");
  EXPECT_EQ(first.mesh.patch_groups.at({{1, std::nullopt}, 1}).name, "Load");
}

TEST(AbaqusAssembly, AnInstanceMayHaveItsOwnMesh) {
  const std::string mesh =
      "*Node\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n*Element, type=C3D4, elset=E\n1, 1, 2, 3, 4\n";
  const std::string empty = "*Part, name=P\n*End Part\n*Assembly, name=A\n";
  const ReadTetMesh r = read(empty + instance("I", "P", mesh) + instance("J", "P", mesh));
  EXPECT_EQ(r.mesh.tets.size(), 2u);
  EXPECT_EQ(r.mesh.points.size(), 8u);
  expect_input_error(read_abaqus, empty + instance("I", "P", "1, 0, 0\n" + mesh), "line 6", "dependent");
  expect_input_error(read_abaqus, assembly(instance("I", "Pin", mesh)), "line 35",
                     "beside those of its part");
  // Sets of an instance add to those of its part.
  const ReadTetMesh sets =
      read(assembly(instance("I", "Block", "*Elset, elset=Top\n7\n*Surface, name=Roof\nTop, S1\n")));
  EXPECT_EQ(sets.mesh.patch_groups.size(), 1u);
}

TEST(AbaqusAssembly, TetsOfTenNodes) {
  const std::string part =
      "*Part, name=P\n*Node\n1, 0, 0, 0\n2, 2, 0, 0\n3, 0, 2, 0\n4, 0, 0, 2\n5, 1, 0, 0\n6, 1, 1, 0\n"
      "7, 0, 1, 0\n8, 0, 0, 1\n9, 1, 0, 1\n10, 0, 1, 1\n*Element, type=C3D10\n1, 1, 2, 3, 4, 5, 6, 7, 8, 9, "
      "10\n"
      "*End Part\n*Assembly, name=A\n";
  const ReadTetMesh r = read(part + instance("I", "P") + instance("J", "P", "9, 0, 0\n"));
  EXPECT_EQ(r.mesh.points.size(), 8u);
  EXPECT_EQ(r.mesh.points[5], Vec3(11, 0, 0));
  EXPECT_EQ(r.dropped.at(0), (Dropped{"midside nodes; tets of ten nodes are reduced to their corners", 12}));
}

TEST(AbaqusAssembly, BadInput) {
  const auto bad = [](const std::string& text, const std::string& first, const std::string& second) {
    SCOPED_TRACE(text);
    expect_input_error(read_abaqus, text, first, second);
  };
  bad(assembly(instance("I", "Pine")), "line 34", "\"Pine\", which no earlier *PART defines");
  bad(assembly(instance("I", "Pin") + instance("i", "Pin")), "line 36", "second instance");
  bad(assembly("*Instance, name=I, part=Pin\n"), "*END INSTANCE of the instance \"I\"",
      "line 34, is missing");
  bad(assembly("*Instance, name=I\n"), "line 34", "without PART=");
  bad(assembly("*Instance, library=old, instance=I\n"), "line 34", "previous analysis");
  bad(assembly(instance("I", "Pin", "1, 2, x\n")), "line 35", "\"x\" is not a finite");
  bad(assembly(instance("I", "Pin", "1, 2, 1e999\n")), "line 35", "finite");
  bad(assembly(instance("I", "Pin", "1, 2, 3, 4\n")), "line 35", "3 numbers of a translation");
  bad(assembly(instance("I", "Pin", "1, 2, 3\n1, 2, 3, 1, 2, 3, 90\n")), "line 36", "no length");
  bad(assembly(instance("I", "Pin", "1, 2, 3\n1, 2, 3, 1, 2, 4\n")), "line 36", "7 numbers of a rotation");
  bad(assembly(instance("I", "Pin", "1, 2, 3\n0, 0, 0, 0, 0, 1, 5\n3, 3, 3\n")), "line 37", "third line");
  bad(assembly(instance("I", "Pin", "1e308, 0, 0\n1e308, 0, 0, -1e308, 0, 0, 9\n")), "line 36", "too far");
  bad(assembly(instance("I", "Pin", "0, 0, 0\n1.7e308, 0, 0, 1.7e308, 1, 0, 180\n")), "line 34",
      "out of the range");
  bad(parts, "3 parts", "no *INSTANCE");
  bad("*Part, name=P\n*Node\n1, 0, 0, 0\n*Part, name=Q\n", "line 4",
      "*END PART of the part \"P\", which begins in line 1");
  bad("*Part, name=P\n*Node\n1, 0, 0, 0\n", "*END PART", "at the end of the file");
  bad("*Part, name=P\n*End Part\n*Part, name=p\n*End Part\n", "line 3", "second part");
  bad("*Part\n*End Part\n", "line 1", "without NAME=");
  bad("*End Part\n", "line 1", "without its beginning");
  bad(parts + "*Node\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n*Element, type=C3D4\n1, 1, 2, 3, 4\n",
      "line 38", "outside of *PART");
  const std::string two = instance("I", "Pin") + instance("J", "Pin", "5, 0, 0\n");
  bad(assembly(two, "*Elset, elset=S, instance=K\n7\n*Surface, name=L\nS, S1\n"), "line 39",
      "no instance \"K\"");
  bad(assembly(two, "*Surface, name=L\nJ.None, S1\n"), "line 40", "\"NONE\" in the instance \"J\"");
  bad(assembly(two, "*Surface, name=L\nNone, S1\n"), "line 40", "in the assembly");
  bad(assembly(two, "*Elset, elset=S, instance=J, generate\n1, 4000000000, 1\n"), "line 40", "more");
  const std::string hexahedra =
      "*Part, name=H\n*Node\n1, 0, 0, 0\n*Element, type=C3D8\n1, 1, 1, 1, 1, 1, 1, 1, 1\n*End Part\n";
  bad(hexahedra + assembly(two + instance("K", "H")), "line 4", "C3D8");
  EXPECT_EQ(read(hexahedra + assembly(two)).mesh.tets.size(), 2u);
}

TEST(AbaqusAssembly, QuotedNamesInDataLines) {
  const ReadTetMesh r = read(
      "*Node\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n*Element, type=C3D4\n1, 1, 2, 3, 4\n"
      "*Elset, elset=\"_Foot 1_S1\"\n1\n*Surface, type=ELEMENT, name=\"Foot 1\"\n\"_Foot 1_S1\", S1\n");
  ASSERT_EQ(r.mesh.patch_groups.size(), 1u);
  EXPECT_EQ(r.mesh.patch_groups.begin()->second.name, "Foot 1");
}

TEST(AbaqusAssembly, DeeplyNestedSetsAreRefused) {
  std::string text =
      "*Node\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n*Element, type=C3D4\n1, 1, 2, 3, 4\n*Elset, "
      "elset=s0\n1\n";
  for (int i = 1; i <= 100000; ++i)
    text += "*Elset, elset=s" + std::to_string(i) + "\ns" + std::to_string(i - 1) + "\n";
  expect_input_error(read_abaqus, text + "*Solid Section, elset=s100000, material=m\n,\n",
                     "more than 1000 element sets include each other");
  EXPECT_EQ(read(text + "*Solid Section, elset=s900, material=m\n,\n").mesh.material_names.at(1), "s900");
}

// Cohesive elements belong to the mesh only inside of parts with tets.
TEST(AbaqusAssembly, CohesiveElementsOutsideOfPartsAreNamed) {
  const ReadTetMesh r = read(assembly(instance("Block-1", "Block"),
                                      "*Node\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 0\n5, 1, 0, 0\n6, "
                                      "0, 1, 0\n*Element, type=COH3D6\n1, 1, 2, 3, 4, 5, 6\n"));
  EXPECT_TRUE(r.mesh.wedges.empty());
  EXPECT_NE(std::find(r.dropped.begin(), r.dropped.end(),
                      Dropped{"cohesive elements outside of parts with tets", 1}),
            r.dropped.end());
}

TEST(AbaqusAssembly, EveryBeginningOfAFileIsReadOrRefused) {
  const std::string whole =
      assembly(instance("I", "Pin", "1, 2, 3\n0, 0, 0, 0, 0, 1, 5\n") + instance("J", "Block"),
               "*Elset, elset=S, instance=J\n7\n*Surface, name=L\nS, S1\n");
  for (std::size_t n = 0; n < whole.size(); ++n) {
    try {
      (void)read(whole.substr(0, n));
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace tetwright::abaqus_assembly_test

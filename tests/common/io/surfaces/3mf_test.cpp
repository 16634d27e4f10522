// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/3mf.h"

#include "tests/common/io/expect_error.h"
#include "tests/common/io/zip_of.h"

namespace tetwright::three_mf_test {
namespace {

/// A tet with one corner at the origin, as the mesh of an object.
const std::string tet_mesh =
    "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"
    "<vertex x=\"0\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices><triangles>"
    "<triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/>"
    "<triangle v1=\"0\" v2=\"3\" v3=\"2\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/></triangles></mesh>";

std::string object(const std::string& attributes, const std::string& content) {
  return "<object " + attributes + ">" + content + "</object>\n";
}

std::string model(const std::string& objects, const std::string& items) {
  return "<?xml version=\"1.0\"?>\n<model unit=\"millimeter\" "
         "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n<resources>\n" +
         objects + "</resources>\n<build>" + items + "</build></model>";
}

std::string file(const std::string& objects, const std::string& items) {
  return zip_of({{"_rels/.rels", relationships_of_3mf}, {"3D/a.model", model(objects, items)}});
}

/// Six times the volume, positive if the triangles face outwards.
double six_volumes(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += mesh.points[t[0]].dot(mesh.points[t[1]].cross(mesh.points[t[2]]));
  return sum;
}

TEST(ThreeMf, ItemsArePlacedByTheirTransforms) {
  const TriangleMesh mesh =
      read_3mf(file(object("id=\"7\"", tet_mesh),
                    "<item objectid=\"7\"/><item objectid=\"7\" transform=\"0 2 0 -2 0 0 0 0 2 10 20 30\"/>"),
               "f");
  ASSERT_EQ(mesh.points.size(), 8u);
  EXPECT_EQ(mesh.points[1], Vec3(1, 0, 0));
  EXPECT_EQ(mesh.points[5], Vec3(10, 22, 30));  // the x axis becomes twice the y axis
  EXPECT_EQ(mesh.points[6], Vec3(8, 20, 30));
  EXPECT_EQ(mesh.triangles.size(), 8u);
  EXPECT_EQ(mesh.triangles[4], (Triangle{4, 6, 5}));
  EXPECT_TRUE(mesh.groups.empty());  // one object
}

TEST(ThreeMf, MirroredObjectsFaceOutwards) {
  const TriangleMesh mesh = read_3mf(
      file(object("id=\"1\"", tet_mesh), "<item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/>"),
      "f");
  EXPECT_DOUBLE_EQ(six_volumes(mesh), 1);
}

TEST(ThreeMf, ObjectsAreGroupsByTheirNamesAlsoAsComponents) {
  const std::string objects =
      object("id=\"1\" name=\"bone &amp; &#x6d;arrow\"", tet_mesh) + object("id=\"2\"", tet_mesh) +
      object("id=\"3\" name=\"skin\"",
             "<components><component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/>"
             "<component objectid=\"2\"/></components>") +
      object("id=\"4\"", tet_mesh) + object("id=\"5\" name=\"skin\"", tet_mesh);
  const TriangleMesh mesh = read_3mf(file(objects,
                                          "<item objectid=\"3\" transform=\"1 0 0 0 1 0 0 0 1 0 7 0\"/><item "
                                          "objectid=\"4\"/><item objectid=\"5\"/>"),
                                     "f");
  EXPECT_EQ(mesh.groups,
            (std::vector<SurfaceRegion>{{0, "bone & marrow"}, {0, "skin"}, {3, ""}, {0, "skin_2"}}));
  EXPECT_EQ(mesh.points[1], Vec3(6, 7, 0));
  EXPECT_EQ(mesh.triangle_groups[0], 0u);
  EXPECT_EQ(mesh.triangle_groups[15], 3u);
}

TEST(ThreeMf, AnUnnamedObjectIsOfTheAssemblyThatHasIt) {
  const auto assembly = [](const std::string& attributes) {
    return object(attributes, "<components><component objectid=\"1\"/></components>");
  };
  // The type of an object with components is ignored.
  const TriangleMesh mesh =
      read_3mf(file(object("id=\"1\"", tet_mesh) + assembly("id=\"2\" name=\"left\"") +
                        assembly("id=\"3\" name=\"right\" type=\"support\""),
                    "<item objectid=\"2\"/><item objectid=\"3\"/><item objectid=\"2\"/>"),
               "f");
  EXPECT_EQ(mesh.groups, (std::vector<SurfaceRegion>{{0, "left"}, {0, "right"}}));
  EXPECT_EQ(mesh.triangle_groups, (std::vector<std::uint32_t>{0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0}));
}

TEST(ThreeMf, ObjectsOfOtherParts) {
  const std::string root =
      model(object("id=\"1\"",
                   "<components><component p:path=\"/3D/Objects/b.model\" objectid=\"1\"/></components>"),
            "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 3 0 0\"/>");
  const TriangleMesh mesh =
      read_3mf(zip_of({{"_rels/.rels", relationships_of_3mf},
                       {"3D/a.model", root},
                       {"3D/Objects/b.model", model(object("id=\"1\"", tet_mesh), "")}}),
               "f");
  ASSERT_EQ(mesh.points.size(), 4u);
  EXPECT_EQ(mesh.points[0], Vec3(3, 0, 0));
}

TEST(ThreeMf, WhatIsDroppedIsNamed) {
  std::string coloured = tet_mesh;
  coloured.replace(coloured.find("v3=\"1\""), 6, "v3=\"1\" pid=\"9\" p1=\"0\"");
  coloured.insert(coloured.find("</mesh>"), "<b:beamlattice/>");
  std::vector<Dropped> dropped;
  (void)read_3mf(file(object("id=\"1\" pid=\"9\"", coloured) + object("id=\"2\" type=\"support\"", tet_mesh) +
                          object("id=\"3\"", "<v:levelset/>"),
                      "<item objectid=\"1\"/><item objectid=\"2\"/><item objectid=\"3\"/>"),
                 "f", &dropped);
  EXPECT_EQ(dropped, (std::vector<Dropped>{{"objects with a colour, material or texture", 1},
                                           {"triangles with a colour, material or texture", 1},
                                           {"beam lattices", 1},
                                           {"support objects", 1},
                                           {"objects that are not meshes", 1}}));
}

TEST(ThreeMf, BadInput) {
  const std::string good = object("id=\"1\"", tet_mesh), item = "<item objectid=\"1\"/>";
  expect_input_error(read_3mf, "", "empty");
  expect_input_error(read_3mf, "PK\3\4 and so on", "ZIP", "damaged");
  expect_input_error(read_3mf, file(good, item).substr(0, 300), "ZIP", "truncated");
  expect_input_error(read_3mf, zip_of({{"a.txt", "text"}}), "no 3D model", "3MF");
  expect_input_error(read_3mf, zip_of({{"_rels/.rels", relationships_of_3mf}}), "\"3D/a.model\"", "damaged");
  expect_input_error(read_3mf, file(good, ""), "no object is placed");
  expect_input_error(read_3mf, file(good, "<item objectid=\"2\"/>"), "3D/a.model: line 6", "the id \"2\"");
  expect_input_error(read_3mf, file(good, "<item/>"), "line 6", "\"objectid\"");
  expect_input_error(read_3mf, file(good + good, item), "line 5", "another object with the id \"1\"");
  expect_input_error(read_3mf, file(good, "<item objectid=\"1\" transform=\"1 0 0\"/>"), "twelve numbers",
                     "\"1 0 0\"");
  expect_input_error(read_3mf,
                     file(object("id=\"1\"", "<components><component objectid=\"1\"/></components>"), item),
                     "line 4", "part of itself");
  expect_input_error(read_3mf, file(good, "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 0 0 0 7\"/>"),
                     "twelve numbers");
  const auto with_root = [&](const std::string& attributes) {
    std::string text = model(good, item);
    text.insert(text.find("unit="), attributes + " ");
    return text;
  };
  const auto alone = [](const std::string& text) {
    return zip_of({{"_RELS/.rels", relationships_of_3mf}, {"3D/A.model", text}});
  };
  const std::string booleans = "xmlns:bo=\"http://schemas.3mf.io/3dmanufacturing/booleanoperations/2023/07\"";
  EXPECT_EQ(read_3mf(alone(with_root(booleans)), "f").points.size(), 4u);
  expect_input_error(read_3mf, alone(with_root(booleans + " requiredextensions=\"bo\"")), "booleanoperations",
                     "not supported");
  std::string inches = model(object("id=\"1\"", tet_mesh), "");
  inches.replace(inches.find("millimeter"), 10, "inch");
  expect_input_error(read_3mf,
                     zip_of({{"_rels/.rels", relationships_of_3mf},
                             {"3D/a.model", model(good, "<item objectid=\"1\" p:path=\"/3D/b.model\"/>")},
                             {"3D/b.model", inches}}),
                     "b.model", "\"inch\"");
  expect_input_error(read_3mf, alone(std::string(70'000'000, ' ')), "3D/a.model", "more than 200;");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string mesh = tet_mesh;
    mesh.replace(mesh.find(from), from.size(), to);
    return file(object("id=\"1\"", mesh), item);
  };
  expect_input_error(read_3mf, changed("v3=\"1\"", "v3=\"4\""), "line 4", "vertex 4");
  expect_input_error(read_3mf, changed("v3=\"1\"", "v3=\"-1\""), "line 4", "vertex -1");
  expect_input_error(read_3mf, changed("v3=\"1\"", ""), "line 4", "without \"v3\"");
  expect_input_error(read_3mf, changed("x=\"0\"", "x=\"?\""), "line 4", "found \"?\"");
  expect_input_error(read_3mf, changed("x=\"0\"", "x=\"nan\""), "line 4");
  expect_input_error(read_3mf, changed("</vertices>", ""), "not XML");
}

TEST(ThreeMf, ComponentsThatMultiplyAreRefused) {
  std::string objects = object("id=\"0\"", tet_mesh);
  for (int level = 1; level < 7; ++level) {
    std::string components;
    for (int i = 0; i < 10; ++i) components += "<component objectid=\"" + std::to_string(level - 1) + "\"/>";
    objects += object("id=\"" + std::to_string(level) + "\"", "<components>" + components + "</components>");
  }
  expect_input_error(read_3mf, file(objects, "<item objectid=\"6\"/>"), "more than 100000 times");
}

TEST(ThreeMf, ComponentsInAnyDepthEnd) {
  std::string objects = object("id=\"0\"", tet_mesh);
  for (int level = 1; level <= 20000; ++level)
    objects += object("id=\"" + std::to_string(level) + "\"",
                      "<components><component objectid=\"" + std::to_string(level - 1) + "\"/></components>");
  EXPECT_EQ(read_3mf(file(objects, "<item objectid=\"900\"/>"), "f").points.size(), 4u);
  expect_input_error(read_3mf, file(objects, "<item objectid=\"20000\"/>"), "is nested in more than");
}

}  // namespace
}  // namespace tetwright::three_mf_test

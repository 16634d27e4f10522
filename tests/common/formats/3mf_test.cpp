#include "common/formats/3mf.h"

#include <zip.h>

#include "tests/common/formats/expect_error.h"

namespace tetwright::three_mf_test {
namespace {

using Parts = std::vector<std::pair<std::string, std::string>>;

/// A ZIP archive with these files.
std::string archive(const Parts& parts) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(nullptr, 0, 0, &error);
  zip_source_keep(source);
  zip_t* zip = zip_open_from_source(source, ZIP_TRUNCATE, &error);
  for (const auto& [name, content] : parts)
    zip_file_add(zip, name.c_str(), zip_source_buffer(zip, content.data(), content.size(), 0), 0);
  EXPECT_EQ(zip_close(zip), 0);
  std::string bytes;
  zip_source_open(source);
  char chunk[4096];
  for (zip_int64_t n; (n = zip_source_read(source, chunk, sizeof chunk)) > 0;)
    bytes.append(chunk, static_cast<std::size_t>(n));
  zip_source_close(source);
  zip_source_free(source);
  return bytes;
}

const std::string relationships =
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Target=\"/3D/a.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";

/// A tet with its corner at the origin, as the mesh of an object.
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
  return archive({{"_rels/.rels", relationships}, {"3D/a.model", model(objects, items)}});
}

/// Six times the volume, which is positive if the triangles face outwards.
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
  EXPECT_EQ(mesh.groups, (std::vector<FaceGroup>{{0, "bone & marrow"}, {0, "skin"}, {3, ""}, {0, "skin_2"}}));
  EXPECT_EQ(mesh.points[1], Vec3(6, 7, 0));
  EXPECT_EQ(mesh.triangle_groups[0], 0u);
  EXPECT_EQ(mesh.triangle_groups[15], 3u);
}

TEST(ThreeMf, ObjectsOfOtherParts) {
  const std::string root =
      model(object("id=\"1\"",
                   "<components><component p:path=\"/3D/Objects/b.model\" objectid=\"1\"/></components>"),
            "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 3 0 0\"/>");
  const TriangleMesh mesh =
      read_3mf(archive({{"_rels/.rels", relationships},
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
  (void)read_3mf(file(object("id=\"1\"", coloured) + object("id=\"2\" type=\"support\"", tet_mesh),
                      "<item objectid=\"1\"/><item objectid=\"2\"/>"),
                 "f", &dropped);
  EXPECT_EQ(dropped, (std::vector<Dropped>{{"triangles with a colour, material or texture", 1},
                                           {"beam lattices", 1},
                                           {"objects that support others", 1}}));
}

TEST(ThreeMf, BadInput) {
  const std::string good = object("id=\"1\"", tet_mesh), item = "<item objectid=\"1\"/>";
  expect_input_error(read_3mf, "", "empty");
  expect_input_error(read_3mf, "PK\3\4 and so on", "ZIP", "damaged");
  expect_input_error(read_3mf, file(good, item).substr(0, 300), "ZIP", "cut short");
  expect_input_error(read_3mf, archive({{"a.txt", "text"}}), "no 3D model", "3MF");
  expect_input_error(read_3mf, archive({{"_rels/.rels", relationships}}), "\"3D/a.model\"", "damaged");
  expect_input_error(read_3mf, file(good, ""), "builds no object");
  expect_input_error(read_3mf, file(good, "<item objectid=\"2\"/>"), "3D/a.model: line 6", "the id \"2\"");
  expect_input_error(read_3mf, file(good, "<item/>"), "line 6", "\"objectid\"");
  expect_input_error(read_3mf, file(good + good, item), "line 5", "another object with the id \"1\"");
  expect_input_error(read_3mf, file(good, "<item objectid=\"1\" transform=\"1 0 0\"/>"), "twelve numbers",
                     "\"1 0 0\"");
  expect_input_error(read_3mf,
                     file(object("id=\"1\"", "<components><component objectid=\"1\"/></components>"), item),
                     "line 4", "part of itself");
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

}  // namespace
}  // namespace tetwright::three_mf_test

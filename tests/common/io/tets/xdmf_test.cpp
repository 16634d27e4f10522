// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/xdmf.h"

#include "tests/common/io/expect_error.h"
#include "tests/common/io/file_test.h"
#include "tests/common/io/round_trip.h"
#include "tests/common/io/tricky_meshes.h"
#include "tetwright/io.h"

namespace tetwright::xdmf_test {
namespace {

using Xdmf = FileTest;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

const std::string small =
    "<?xml version=\"1.0\"?><Xdmf Version=\"3.0\"><Domain><Grid Name=\"Grid\">\n"
    "<Geometry Type=\"XYZ\"><DataItem Dimensions=\"4 3\" Format=\"XML\">0 0 0 1 0 0 0 1 0\n0 0 "
    "1</DataItem></Geometry>\n"
    "<Topology Type=\"Tetrahedron\"><DataItem Dimensions=\"1 4\" Format=\"XML\" DataType=\"Int\">0 1 2 "
    "3</DataItem></Topology>\n"
    "<Attribute Name=\"zone\" Center=\"Cell\"><DataItem Dimensions=\"1\" Format=\"XML\" "
    "DataType=\"Int\">7</DataItem></Attribute>\n"
    "<Attribute Name=\"t\" Center=\"Node\"><DataItem Dimensions=\"4\" Format=\"XML\">1 2 nan "
    "4</DataItem></Attribute>\n"
    "</Grid></Domain></Xdmf>";

ReadTetMesh read(const std::string& text) {
  return read_xdmf(text, "f",
                   [](const std::string& path) -> std::string { throw InputError(path + ": is not there"); });
}

TEST_F(Xdmf, RoundTripKeepsEveryBit) {
  TetMesh mesh = tricky_measurable_tets();
  mesh.point_fields = {{"a <b>", 3, false, std::vector<double>(15, 0.1)}, {"n", 1, true, {1, 2, 3, 4, 5e9}}};
  mesh.cell_fields = {{"id", 1, true, {1, 2, 3}}};
  write_tet_mesh(mesh, path("m.xdmf"));
  EXPECT_EQ(files(), 4u);
  const std::string first = get(path("m.h5"));
  const ReadTetMesh back = read_tet_mesh(path("m.xdmf"));
  EXPECT_TRUE(same_bits(back.mesh.points, mesh.points));
  EXPECT_EQ(back.mesh.tets, mesh.tets);
  EXPECT_EQ(back.mesh.materials, mesh.materials);
  mesh.material_names[-2147483647 - 1] = "material_-2147483648";
  EXPECT_EQ(back.mesh.material_names, mesh.material_names);
  EXPECT_EQ(back.mesh.point_fields, mesh.point_fields);
  EXPECT_EQ(back.mesh.cell_fields, mesh.cell_fields);
  write_tet_mesh(mesh, path("m.xdmf"));
  EXPECT_EQ(get(path("m.h5")), first);
}

TEST_F(Xdmf, FacetsHaveAFileOfTheirOwn) {
  write_tet_mesh(mesh_with_surfaces(), path("m.xdmf"));
  const std::string facets = get(path("m_facets.xdmf"));
  for (const char* part :
       {"<Grid Name=\"facet_tags\"", "NumberOfElements=\"7\"", "m_facets.h5:/triangles", "m.h5:/points",
        "m_facets.h5:/facet_tags", "key=&quot;outlet&quot; dim=&quot;2&quot;&gt;5&lt;",
        "Attribute Name=\"facet_tags\""})
    EXPECT_NE(facets.find(part), std::string::npos) << part << "\n" << facets;
  EXPECT_NE(get(path("m.xdmf")).find("<Grid Name=\"mesh\""), std::string::npos);
  write_tet_mesh(mesh_with_surfaces(), path("M.XDMF"));
  EXPECT_NE(get(path("M_FACETS.XDMF")).find("M_FACETS.H5:/triangles"), std::string::npos);
  EXPECT_EQ(get(path("M_FACETS.H5")), get(path("m_facets.h5")));
}

TEST_F(Xdmf, PatchesAreReadFromTheFacetsBesideIt) {
  const TetMesh mesh = mesh_with_surfaces();
  const MidsideNodes midside = straight_midside_nodes(mesh);
  for (const char* name : {"m.xdmf", "M.XDMF", " y.xdmf"})
    for (const bool curved : {false, true}) {
      SCOPED_TRACE(name);
      write_tet_mesh({mesh, curved ? &midside : nullptr}, path(name));
      const ReadTetMesh back = read_tet_mesh(path(name));
      EXPECT_EQ(back.mesh.patch_groups, mesh.patch_groups);
      ASSERT_FALSE(back.dropped.empty());
      EXPECT_EQ(back.dropped.back(), (Dropped{"boundary and interface triangles of 3 groups", 6, true}));
    }
}

TEST_F(Xdmf, FacetsOfOtherPointsAreSaid) {
  write_tet_mesh(one_tet(), path("m.xdmf"));
  EXPECT_TRUE(read_tet_mesh(path("m.xdmf")).dropped.empty());  // the file has none
  write_tet_mesh(mesh_with_surfaces(), path("a.xdmf"));
  put(path("m_facets.xdmf"), get(path("a_facets.xdmf")));
  EXPECT_EQ(read_tet_mesh(path("m.xdmf")).dropped,
            (std::vector<Dropped>{{"facet files for other points (\"m_facets.xdmf\")", 1}}));
  put(path("m_facets.xdmf"), "cut");
  EXPECT_NE(error_of<InputError>([&] { (void)read_tet_mesh(path("m.xdmf")); }).find("m_facets.xdmf"),
            std::string::npos);
}

TEST_F(Xdmf, TenNodesByTheirCorners) {
  const TetMesh mesh = mesh_with_surfaces();
  const MidsideNodes midside = straight_midside_nodes(mesh);
  write_tet_mesh({mesh, &midside}, path("m.xdmf"));
  const ReadTetMesh back = read_tet_mesh(path("m.xdmf"));
  EXPECT_EQ(back.mesh.points, mesh.points);
  EXPECT_EQ(back.mesh.tets, mesh.tets);
  ASSERT_EQ(back.dropped.size(), 2u);
  EXPECT_EQ(back.dropped[0].count, 9u);
}

TEST_F(Xdmf, NumbersInTheText) {
  const ReadTetMesh r = read(small);
  EXPECT_EQ(r.mesh.points, one_tet().points);
  EXPECT_EQ(r.mesh.tets, one_tet().tets);
  EXPECT_EQ(r.mesh.materials, (std::vector<MaterialTag>{7}));
  EXPECT_EQ(r.material_field, "zone");
  EXPECT_EQ(r.mesh.point_fields.size(), 1u);
}

TEST_F(Xdmf, BadInput) {
  const auto expect = [](const std::string& text, const std::string& first, const std::string& second = "") {
    const std::string message = error_of<InputError>([&] { (void)read(text); });
    EXPECT_NE(message.find(first), std::string::npos) << message;
    EXPECT_NE(message.find(second), std::string::npos) << message;
  };
  expect("", "byte 0");
  expect("<a/>", "no element Xdmf");
  expect(replaced(small, "Tetrahedron", "Hexahedron"), "no grid of tets", "\"hexahedron\"");
  expect(replaced(small, "0 1 2 3", "0 1 2 4"), "Topology", "refers to point 4 of 4");
  expect(replaced(small, "0 1 2 3", "0 1 2 2.5"), "Topology", "2.5");
  expect(replaced(small, "0 1 2 3", "0 1 2"), "fewer nodes");
  expect(replaced(small, "0 1 2 3", "0 1 2 3 4"), "more than the 4");
  expect(replaced(small, "0 0 1<", "0 0 inf<"), "Geometry", "not finite");
  expect(replaced(small, "\"4 3\"", "\"4000000000 3\""), "fewer coordinates", "");
  expect(replaced(small, "\"4 3\"", "\"5000000000 3\""), "too many");
  expect(replaced(small, "XYZ", "XY"), "\"XY\"");
  expect(replaced(small, ">1 2 nan 4<", ">1 2 3<"), "Attribute", "3 values for 4 points");
  expect(replaced(small, "Format=\"XML\">0", "Format=\"Binary\">0"), "\"Binary\"");
  expect(replaced(small, "Format=\"XML\">0 0 0", "Format=\"HDF\">a.h5:/p "), "a.h5", "not there");
  put(path("m.xdmf"), replaced(small, "Format=\"XML\">0 0 0 1 0 0 0 1 0\n0 0 1", "Format=\"HDF\">a.h5:/p"));
  const auto from_file = [&] { return error_of<InputError>([&] { (void)read_tet_mesh(path("m.xdmf")); }); };
  put(path("a.h5"), "no HDF5");
  EXPECT_NE(from_file().find("a.h5: this is not an HDF5 file"), std::string::npos);
  write_tet_mesh(one_tet(), path("b.xdmf"));
  put(path("a.h5"), get(path("b.h5")));
  EXPECT_NE(from_file().find("a.h5: dataset \"/p\" is missing"), std::string::npos);
}

}  // namespace
}  // namespace tetwright::xdmf_test

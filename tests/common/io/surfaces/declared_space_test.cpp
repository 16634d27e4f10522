// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/declared_space.h"

#include <gtest/gtest.h>

#include "tetwright/io.h"

namespace tetwright::declared_space_test {
namespace {

const char* const lps = "left-posterior-superior";
const char* const ras = "right-anterior-superior";

TEST(DeclaredSpace, IsLpsOrRas) {
  EXPECT_EQ(declared_space("3D Slicer output. SPACE=LPS"), lps);
  EXPECT_EQ(declared_space("SPACE=RAS;UNIT=mm"), ras);
  EXPECT_EQ(declared_space("WORKSPACE=LPS, SPACE=RAS"), ras);
  for (const char* other : {"", "SPACE=", "SPACE=LPI", "SPACE=LPSX", "SPACE=lps", "SPACE LPS",
                            "WORKSPACE=LPS", "SPACE=RAS-LPS", "SPACE = LPS"})
    EXPECT_EQ(declared_space(other), "") << other;
}

TEST(DeclaredSpace, MayBeInCommentsBeforeTheFirstStatement) {
  EXPECT_EQ(space_in_comments("# made by a program\r\n\n  # SPACE=LPS\nv 0 0 0\n", '#'), lps);
  EXPECT_EQ(space_in_comments("v 0 0 0\n# SPACE=LPS\n", '#'), "");
  EXPECT_EQ(space_in_comments("# SPACE=RAS", '#'), ras);
}

std::string stl_text(const std::string& title) {
  return "solid " + title +
         "\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
         "0\nendloop\nendfacet\nendsolid\n";
}

std::string stl_bytes(std::string title) {
  title.resize(80, '\0');
  title += std::string("\1\0\0\0", 4);
  title.append(50, '\0');
  const float one = 1;
  for (const std::size_t at : {108, 124}) title.replace(at, 4, reinterpret_cast<const char*>(&one), 4);
  return title;
}

std::string vtp(const std::string& tuples, const std::string& text) {
  std::string numbers;
  for (const char c : text) numbers += std::to_string(static_cast<int>(c)) + " ";
  return R"(<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"><PolyData><FieldData>)"
         R"(<Array type="String" Name="SPACE" )" +
         tuples + R"(format="ascii">)" + numbers +
         R"(0</Array></FieldData><Piece NumberOfPoints="3" NumberOfPolys="1"><Points>)"
         R"(<DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0</DataArray></Points>)"
         R"(<Polys><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2</DataArray>)"
         R"(<DataArray type="Int64" Name="offsets" format="ascii">3</DataArray></Polys></Piece></PolyData></VTKFile>)";
}

TEST(DeclaredSpace, IsReadFromAllFormatsThatNameIt) {
  // As 3D Slicer writes it, except for `name`.
  for (const std::string name : {"LPS", "RAS", "LPI", ""}) {
    const std::string title = name.empty() ? "made by hand" : "3D Slicer output. SPACE=" + name;
    const std::string expected = name == "LPS" ? lps : name == "RAS" ? ras : "";
    const auto space = [](const std::string& bytes, const char* extension) {
      return read_surface_bytes(bytes, "f", extension).space;
    };
    EXPECT_EQ(space(stl_text(title), ".stl"), expected);
    EXPECT_EQ(space(stl_text("") + stl_text(title), ".stl"), expected);
    EXPECT_EQ(space(stl_bytes(title), ".stl"), expected);
    EXPECT_EQ(space("# " + title + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ".obj"), expected);
    EXPECT_EQ(
        space("ply\nformat ascii 1.0\ncomment VTK generated PLY File\ncomment " +
                  (name.empty() ? "" : "SPACE=" + name) +
                  "\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement "
                  "face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 "
                  "2\n",
              ".ply"),
        expected);
    EXPECT_EQ(
        space("# vtk DataFile Version 4.2\n" + title +
                  "\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n",
              ".vtk"),
        expected);
    EXPECT_EQ(space(vtp("NumberOfTuples=\"1\" ", name), ".vtp"), expected);
  }
  EXPECT_EQ(read_surface_bytes(vtp("", "LPS"), "f", ".vtp").space, "");
}

}  // namespace
}  // namespace tetwright::declared_space_test

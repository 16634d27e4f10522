// SPDX-License-Identifier: Apache-2.0
#include "common/io/size_files.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/common/io/expect_error.h"
#include "tests/common/io/file_test.h"
#include "tests/common/small_meshes.h"
#include "tetwright/io.h"

namespace tetwright::size_files_test {
namespace {

class SizeFiles : public FileTest {
 protected:
  /// Writes a tet with these fields at its points.
  std::string tet(const std::vector<MeshField>& fields, const std::string& name = "a.vtu") const {
    TetMesh mesh = one_tet();
    mesh.point_fields = fields;
    write_tet_mesh(mesh, path(name));
    return path(name);
  }
  std::string text(const std::string& name, const std::string& content) const {
    put(path(name), content);
    return path(name);
  }
  /// A surface of one triangle at (0, 0), (2, 0) and (0, 2), with a property of its points.
  std::string ply(const std::string& property, const std::string& values) const {
    return text("a.ply",
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
                "z\n" +
                    property + "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                    values + "3 0 1 2\n");
  }
  static double at(const std::string& file, const Vec3& p) {
    const auto wanted = read_mesh_sizes(file)->at(p);
    return wanted ? wanted->length : -1;
  }
  template <class E = InputError>
  static std::string message(const std::string& file) {
    const std::string all = error_of<E>([&] { (void)read_mesh_sizes(file); });
    EXPECT_TRUE(all.starts_with(file + ": ")) << all;
    return all.substr(std::min(all.size(), file.size() + 2));
  }
};

TEST_F(SizeFiles, TheFieldByItsNameOrTheOnlyOne) {
  const MeshField size{"size", 1, false, {1, 1, 1, 1}}, h{"h", 1, true, {2, 2, 2, 2}},
      vector{"sizing", 3, false, std::vector<double>(12, 3)}, other{"other", 1, false, {4, 4, 4, 4}},
      ids{"ids", 1, true, {5, 6, 7, 8}};
  const Vec3 p(0.1, 0.2, 0.3);
  EXPECT_EQ(at(tet({other, h, vector, size}), p), 1);
  EXPECT_EQ(at(tet({other, vector, h}), p), 2);
  EXPECT_EQ(at(tet({ids, {"v", 3, false, std::vector<double>(12, 3)}, other}), p), 4);
  EXPECT_NEAR(at(tet({{"v", 3, false, std::vector<double>(12, 3)}, ids}), p),
              5 * 0.4 + 6 * 0.1 + 7 * 0.2 + 8 * 0.3, 1e-12);
  EXPECT_EQ(at(tet({other}, "a.msh"), p), 4);
  EXPECT_EQ(at(tet({size}), {2, 2, 2}), -1);
}

TEST_F(SizeFiles, WhichFieldIsNotClear) {
  const MeshField a{"a", 1, false, {1, 1, 1, 1}}, b{"b", 1, false, {1, 1, 1, 1}},
      v{"v", 3, false, std::vector<double>(12, 1)};
  EXPECT_EQ(message(tet({a, v, b})),
            "several of its point fields may be the edge length: \"a\", \"b\"; name one \"size\"");
  EXPECT_EQ(message(tet({v})),
            "no point field has one number for each point; there are \"v\"; add one named \"size\"");
  EXPECT_EQ(message(tet({a, {"sizing", 3, false, std::vector<double>(12, 1)}})),
            "its point field \"sizing\" has 3 numbers for each point, but an edge length is one number; give "
            "it one, or rename it");
  EXPECT_EQ(
      message(tet({})),
      "it has no point fields; write the target edge length at each point as a point field named \"size\"");
}

TEST_F(SizeFiles, ValuesMustBeAboveZero) {
  for (const double bad : {0.0, -2.0, std::numeric_limits<double>::infinity(), std::nan("")})
    EXPECT_NE(
        message(tet({{"size", 1, false, {1, 1, bad, 1}}})).find("point 2 (counted from 0) has the value"),
        std::string::npos)
        << bad;
  EXPECT_EQ(message(tet({{"size", 1, false, {1, 1, -0.25, 1}}})),
            "point 2 (counted from 0) has the value -0.25 in point field \"size\"; an edge length must be a "
            "number above 0: correct it");
  EXPECT_NE(
      message(ply("property float size", "0 0 0 1\n2 0 0 0\n0 2 0 1\n")).find("point 1 (counted from 0)"),
      std::string::npos);
}

TEST_F(SizeFiles, Ply) {
  for (const std::string type : {"float", "uchar"}) {
    const auto source = read_mesh_sizes(ply("property " + type + " quality", "0 0 0 1\n2 0 0 3\n0 2 0 5\n"));
    const auto wanted = source->at({0.5, 1, 4});
    ASSERT_TRUE(wanted);
    EXPECT_NEAR(wanted->length, 1 + 0.5 + 2, 1e-12);
    EXPECT_NEAR(wanted->distance, 4, 1e-12);
  }
  EXPECT_NE(
      message(ply("property list uchar int size", "0 0 0 0\n2 0 0 0\n0 2 0 0\n")).find("no point fields"),
      std::string::npos);
}

TEST_F(SizeFiles, Vtp) {
  const auto file = [&](const std::string& values) {
    return text("a.VTP",
                "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData><Piece "
                "NumberOfPoints=\"3\" NumberOfPolys=\"1\"><PointData><DataArray type=\"Float32\" "
                "Name=\"normals\" NumberOfComponents=\"3\" format=\"ascii\">0 0 1 0 0 1 0 0 1</DataArray>"
                "<DataArray type=\"Float64\" Name=\"edge_length\" format=\"ascii\">" +
                    values +
                    "</DataArray></PointData><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
                    "format=\"ascii\">0 0 0 2 0 0 0 2 0</DataArray></Points><Polys><DataArray type=\"Int32\" "
                    "Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray><DataArray type=\"Int32\" "
                    "Name=\"offsets\" format=\"ascii\">3</DataArray></Polys></Piece></PolyData></VTKFile>");
  };
  EXPECT_NEAR(at(file("1 3 5"), {0.5, 1, 1}), 3.5, 1e-12);
  EXPECT_NE(message(file("1 3")).find("edge_length"), std::string::npos);
}

TEST_F(SizeFiles, MshWithAndWithoutTets) {
  const auto file = [&](const std::string& elements) {
    return text(
        "a.msh",
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n7 0 0 0\n2 2 0 0\n3 0 2 0\n4 0 0 2\n"
        "$EndNodes\n$Elements\n1\n" +
            elements +
            "\n$EndElements\n$NodeData\n1\n\"wanted\"\n1\n0\n3\n0\n1\n3\n3 5\n2 3\n7 1\n$EndNodeData\n");
  };
  const auto wanted = read_mesh_sizes(file("1 2 2 0 1 7 2 3"))->at({0.5, 1, 4});
  ASSERT_TRUE(wanted);
  EXPECT_NEAR(wanted->length, 3.5, 1e-12);
  EXPECT_NEAR(wanted->distance, 4, 1e-12);
  // The section lacks the last point, which the tet uses.
  EXPECT_NE(message(file("1 4 2 0 1 7 2 3 4")).find("point 3 (counted from 0) has the value nan"),
            std::string::npos);
}

TEST_F(SizeFiles, OtherExtensions) {
  const std::string known = "edge lengths are read from .vtu .pvtu .msh .vtk .xdmf .node .ele .ply .vtp";
  EXPECT_EQ(message<UsageError>("a.txt"), "unknown extension \".txt\"; " + known);
  EXPECT_EQ(message<UsageError>("a"), "no extension; " + known);
  EXPECT_EQ(message<UsageError>("a.stl"), "files \".stl\" have no point fields; " + known);
  EXPECT_EQ(message<UsageError>("a.mesh"), "files \".mesh\" have no point fields; " + known);
  EXPECT_EQ(error_of<UsageError>([] { check_mesh_sizes_path("a.inr", ".vdb"); }),
            "a.inr: unknown extension \".inr\"; " + known + " .vdb");
  EXPECT_NO_THROW(check_mesh_sizes_path("a.PLY"));
  EXPECT_THROW((void)read_mesh_sizes(path("missing.vtu")), InputError);
  EXPECT_THROW((void)read_surface_with_fields("a.stl"), UsageError);
}

}  // namespace
}  // namespace tetwright::size_files_test

// SPDX-License-Identifier: Apache-2.0

// Coordinate systems in files of tet meshes and of their boundaries.
#include <gtest/gtest.h>

#include "common/io/encodings/hdf5_image.h"
#include "common/io/tets/vtu.h"
#include "common/samples/samples.h"
#include "tests/common/temporary_folder.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::spaces_test {
namespace {

const char* const lps = "left-posterior-superior";
const char* const ras = "right-anterior-superior";

TetMesh mesh_in(const std::string& space) {
  TetMesh mesh = std::get<TetMesh>(make_sample("two_materials"));
  mesh.space = space;
  return mesh;
}

/// Tets in turn.
TetPartition parts_of(const TetMesh& mesh, PartNumber parts) {
  TetPartition partition{.parts = parts, .part_of = {}};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    partition.part_of.push_back(static_cast<PartNumber>(t % parts));
  return partition;
}

TEST(SpacesInFiles, ThoseOfVtkKeepThem) {
  const TemporaryFolder f;
  for (const char* space : {lps, ras}) {
    const TetMesh mesh = mesh_in(space);
    for (const char* file : {"m.vtu", "m.vtk"}) {
      SCOPED_TRACE(file);
      write_tet_mesh(mesh, f / file);
      const ReadTetMesh back = read_tet_mesh(f / file);
      EXPECT_EQ(back.mesh.space, space);
      EXPECT_EQ(back.mesh.points, mesh.points);
      EXPECT_EQ(back.mesh.material_names, mesh.material_names);
      EXPECT_TRUE(back.dropped.empty());
    }
    write_tet_mesh(mesh, parts_of(mesh, 3), f / "m.pvtu");
    const ReadTetMesh joined = read_tet_mesh(f / "m.pvtu");
    EXPECT_EQ(joined.mesh.space, space);
    EXPECT_TRUE(joined.dropped.empty());
  }
}

TEST(SpacesInFiles, VtkHdfHasTheBytesOfTheName) {
  const TemporaryFolder f;
  const TetMesh mesh = mesh_in(ras);
  write_tet_mesh(mesh, parts_of(mesh, 2), f / "m.vtkhdf");
  const std::string bytes = contents(f / "m.vtkhdf");
  EXPECT_EQ(Hdf5Reader(bytes, "m").numbers("/VTKHDF/FieldData/SPACE", 10),
            (std::vector<double>{'R', 'A', 'S'}));
}

TEST(SpacesInFiles, OtherOnesAreNotWritten) {
  const TemporaryFolder f;
  for (const char* file : {"m.vtu", "m.vtk"}) {
    write_tet_mesh(mesh_in(""), f / file);
    const std::string without = contents(f / file);
    write_tet_mesh(mesh_in("scanner-xyz"), f / file);
    EXPECT_EQ(contents(f / file), without) << file;
    EXPECT_EQ(without.find("SPACE"), std::string::npos) << file;
  }
}

TEST(SpacesInFiles, TextsOf3DSlicerAreRead) {
  const auto read = [](const std::string& array) {
    std::string text = write_vtu(mesh_in(""));
    const std::size_t at = text.find("</FieldData>");
    EXPECT_NE(at, std::string::npos);
    return read_vtu(text.insert(at, array), "f");
  };
  const ReadTetMesh slicer =
      read(R"(<Array type="String" Name="SPACE" NumberOfTuples="1" format="ascii">76 80 83 0</Array>)");
  EXPECT_EQ(slicer.mesh.space, lps);
  EXPECT_TRUE(slicer.dropped.empty());
  for (const char* other :
       {R"(<DataArray type="UInt8" Name="SPACE" NumberOfTuples="3" format="ascii">76 65 83</DataArray>)",
        R"(<DataArray type="UInt8" Name="SPACE" NumberOfTuples="3" format="ascii">L P S</DataArray>)",
        R"(<DataArray type="UInt8" Name="SPACE" NumberOfTuples="3" format="ascii">76 80 83 0</DataArray>)",
        R"(<Array type="String" Name="SPACE" NumberOfTuples="1" format="ascii">76 80 83</Array>)",
        R"(<Array type="String" Name="SPACE" NumberOfTuples="1" format="ascii">76 0 80 0</Array>)",
        R"(<Array type="String" Name="SPACE" NumberOfTuples="1" format="binary">*</Array>)",
        R"(<DataArray type="Float64" Name="SPACE" NumberOfTuples="2" format="ascii">0.5 2</DataArray>)"}) {
    const ReadTetMesh found = read(other);
    EXPECT_EQ(found.mesh.space, "");
    ASSERT_EQ(found.dropped.size(), 1u);
    EXPECT_EQ(found.dropped[0].what, "arrays of the whole dataset (\"SPACE\")");
  }
}

TEST(SpacesInFiles, BoundariesHaveThatOfTheMesh) {
  const TemporaryFolder f;
  TetMesh mesh = mesh_in(lps);
  mesh.interfaces = find_interfaces(mesh);
  for (const char* file : {"b.ply", "b.obj", "b.vtp"}) {
    write_interfaces(mesh, f / file);
    const TriangleMesh back = read_surface(f / file);
    EXPECT_EQ(back.space, lps) << file;
    EXPECT_EQ(back.groups.size(), 3u) << file;
  }
}

}  // namespace
}  // namespace tetwright::spaces_test

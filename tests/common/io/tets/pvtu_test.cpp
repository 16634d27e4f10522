// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/pvtu.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <variant>

#include "common/io/tets/vtu.h"
#include "common/random.h"
#include "common/samples/samples.h"
#include "tests/common/small_meshes.h"
#include "tests/common/temporary_folder.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"

namespace tetwright::pvtu_test {
namespace {

/// A mesh with fields, names and groups of faces, one of them with the name of the user.
TetMesh rich_mesh() {
  TetMesh mesh = std::get<TetMesh>(make_sample("two_materials"));
  mesh.interfaces = find_interfaces(mesh);
  for (InterfaceTriangle& t : mesh.interfaces)
    if (!t.other && mesh.points[t.ids[0]].z() == mesh.points[t.ids[1]].z() &&
        mesh.points[t.ids[0]].z() == mesh.points[t.ids[2]].z()) {
      t.patch = 1;
      mesh.patch_groups[{t.pair(), t.patch}] = {40, "floor & <ceiling>"};
    }
  MeshField numbers{.name = "numbers", .components = 2, .integer = true, .values = {}};
  for (std::size_t t = 0; t < 2 * mesh.tets.size(); ++t)
    numbers.values.push_back(t + 1 == 2 * mesh.tets.size() ? 1e12 : static_cast<double>(t));
  MeshField heat{.name = "heat", .values = {}};
  for (std::size_t p = 0; p < mesh.points.size(); ++p)
    heat.values.push_back(1 / (1.0 + static_cast<double>(p)));
  mesh.cell_fields = {numbers};
  mesh.point_fields = {heat};
  return mesh;
}

/// Tets in turn: all parts are everywhere, and have neighbours of all kinds.
TetPartition in_turn(const TetMesh& mesh, PartNumber parts) {
  TetPartition partition{.parts = parts, .part_of = {}};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    partition.part_of.push_back(static_cast<PartNumber>(t / 7 % parts));
  return partition;
}

class Pvtu : public ::testing::Test {
 protected:
  void write(const TetMesh& mesh, PartNumber parts, const MidsideNodes* midside = nullptr) const {
    write_tet_mesh({mesh, midside}, in_turn(mesh, parts), f / "m.pvtu");
  }
  std::string error() const {
    try {
      (void)read_tet_mesh(f / "m.pvtu");
    } catch (const InputError& e) {
      return e.what();
    }
    return "none";
  }
  void expect_error(const std::vector<std::string>& said) const {
    for (const std::string& text : said) EXPECT_NE(error().find(text), std::string::npos) << error();
  }

  TemporaryFolder f;
};

TEST_F(Pvtu, RoundTripsTheWholeMesh) {
  const TetMesh mesh = rich_mesh();
  for (const PartNumber parts : {1U, 3U, 8U}) {
    SCOPED_TRACE(parts);
    write(mesh, parts);
    const ReadTetMesh back = read_tet_mesh(f / "m.pvtu");
    EXPECT_EQ(write_vtu(back.mesh), write_vtu(mesh));
    EXPECT_EQ(back.material_field, "material");
    TetMesh expected = mesh;
    EXPECT_EQ(back.mesh.patch_groups.size(), mesh.patch_groups.size());
    std::size_t named = 0;
    for (const InterfaceTriangle& t : back.mesh.interfaces)
      if (const auto group = back.mesh.patch_groups.find({t.pair(), t.patch});
          group != back.mesh.patch_groups.end()) {
        EXPECT_EQ(group->second, (SurfaceRegion{40, "floor & <ceiling>"}));
        ++named;
      }
    EXPECT_EQ(named, static_cast<std::size_t>(std::count_if(mesh.interfaces.begin(), mesh.interfaces.end(),
                                                            [](const auto& t) { return t.patch == 1; })));
    for (const Dropped& d : back.dropped) EXPECT_TRUE(d.restored) << d.what;
  }
}

TEST_F(Pvtu, ATetMeshWithoutPartsIsOnePiece) {
  const TetMesh mesh = rich_mesh();
  write_tet_mesh(mesh, f / "m.pvtu");
  EXPECT_EQ(f.entries(), 2u);
  EXPECT_TRUE(f.has("m_0.vtu"));
  EXPECT_EQ(write_vtu(read_tet_mesh(f / "m.pvtu").mesh), write_vtu(mesh));
}

TEST_F(Pvtu, SecondOrderTetsAreReducedToTheirCorners) {
  const TetMesh mesh = rich_mesh();
  const MidsideNodes nodes = straight_midside_nodes(mesh);
  write(mesh, 4, &nodes);
  const ReadTetMesh back = read_tet_mesh(f / "m.pvtu");
  EXPECT_EQ(back.mesh.tets, mesh.tets);
  EXPECT_EQ(back.mesh.points, mesh.points);
  EXPECT_EQ(back.mesh.point_fields, mesh.point_fields);
}

TEST_F(Pvtu, PointsWithoutTetsAreKept) {
  TetMesh mesh = two_tets();
  mesh.points.push_back({9, 9, 9});
  write_tet_mesh(mesh, TetPartition{2, {1, 0}}, f / "m.pvtu");
  EXPECT_EQ(read_tet_mesh(f / "m.pvtu").mesh.points, mesh.points);
}

TEST_F(Pvtu, TheBytesDoNotDependOnThreads) {
  const TetMesh mesh = rich_mesh();
  std::vector<std::string> first;
  for (const unsigned threads : {1U, 2U})
    with_threads(threads, [&] {
      write(mesh, 3);
      std::vector<std::string> bytes;
      for (const std::string& file : files_of_tet_mesh(f / "m.pvtu", "", 3)) bytes.push_back(contents(file));
      if (first.empty()) first = bytes;
      EXPECT_EQ(bytes, first);
    });
}

TEST_F(Pvtu, FewerPiecesReplaceMore) {
  const TetMesh mesh = rich_mesh();
  write(mesh, 8);
  write(mesh, 2);
  EXPECT_EQ(pieces_of_pvtu(f / "m.pvtu"), (std::vector<std::string>{f / "m_0.vtu", f / "m_1.vtu"}));
  EXPECT_EQ(read_tet_mesh(f / "m.pvtu").mesh.tets, mesh.tets);
}

TEST_F(Pvtu, AMissingPieceIsNamed) {
  write(rich_mesh(), 3);
  std::filesystem::remove(f / "m_1.vtu");
  expect_error({"piece 1", "m_1.vtu"});
}

TEST_F(Pvtu, ADamagedPieceIsNamed) {
  write(rich_mesh(), 3);
  put(f / "m_2.vtu", contents(f / "m_2.vtu").substr(0, 3000));
  expect_error({"m_2.vtu"});
}

TEST_F(Pvtu, PiecesOfAnotherMeshAreNamed) {
  TetMesh mesh = rich_mesh();
  write(mesh, 3);
  const std::string old = contents(f / "m_1.vtu");
  write(mesh, 2);
  put(f / "m_1.vtu", old);
  expect_error({"names 2 pieces", "piece 1", "is one of 3"});

  write(mesh, 3);
  const std::string index = contents(f / "m.pvtu"), line = "<Piece Source=\"m_2.vtu\"/>\n";
  put(f / "m.pvtu", std::string(index).erase(index.find(line), line.size()));
  expect_error({"names 2 pieces"});

  write(mesh, 3);
  mesh.points[mesh.tets[0][0]] += Vec3(1e-9, 0, 0);
  const std::string before = contents(f / "m_2.vtu");
  write(mesh, 3);
  put(f / "m_2.vtu", before);
  expect_error({"piece 2", "m_2.vtu", "point number", "elsewhere"});
}

TEST_F(Pvtu, NumbersThatAreTwiceOrMissingAreNamed) {
  TetMesh mesh = rich_mesh();
  const auto write_two = [&](const TetPartition& first, const TetPartition& second) {
    write_tet_mesh(mesh, first, f / "m.pvtu");
    const std::string kept = contents(f / "m_0.vtu");
    write_tet_mesh(mesh, second, f / "m.pvtu");
    put(f / "m_0.vtu", kept);
  };
  TetPartition partition = in_turn(mesh, 2), more = partition, fewer = partition;
  more.part_of[10] = 0;
  fewer.part_of[3] = 1;
  ASSERT_NE(partition.part_of[10], 0u);
  ASSERT_NE(partition.part_of[3], 1u);
  write_two(more, partition);
  expect_error({"piece 1", "tet number 10 ", "piece 0"});
  write_two(fewer, partition);
  expect_error({"no piece has the tet number 3 "});
}

TEST_F(Pvtu, GhostsThatDifferFromTheirOwnersAreNamed) {
  TetMesh mesh = two_tets();
  const TetPartition halves{2, {0, 1}};
  const auto write_two = [&](const TetMesh& other) {
    write_tet_mesh(mesh, halves, f / "m.pvtu");
    const std::string kept = contents(f / "m_0.vtu");
    write_tet_mesh(other, halves, f / "m.pvtu");
    put(f / "m_0.vtu", kept);
  };
  TetMesh other = mesh;
  other.materials[0] = 5;
  write_two(other);
  expect_error({"piece 1", "ghost tet number 0 ", "\"material\"", "piece 0"});
  other = mesh;
  other.tets[0] = {1, 2, 0, 3};
  write_two(other);
  expect_error({"piece 1", "ghost tet number 0 ", "other points"});
}

TEST_F(Pvtu, AnyDamageIsRefusedOrHarmless) {
  const TetMesh mesh = rich_mesh();
  write(mesh, 2);
  Random random(5);
  for (const std::string file : {"m.pvtu", "m_0.vtu", "m_1.vtu"}) {
    const std::string good = contents(f / file);
    const auto size = static_cast<std::uint32_t>(good.size());
    for (int i = 0; i < 60; ++i) {
      std::string bad = good;
      for (int k = 0; k < 3; ++k) bad[random.below(size)] = static_cast<char>(' ' + random.below(90));
      if (i % 5 == 0) bad.resize(random.below(size));
      put(f / file, bad);
      try {
        EXPECT_FALSE(read_tet_mesh(f / "m.pvtu").mesh.tets.empty());
      } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("m"), std::string::npos);
      }
    }
    put(f / file, good);
  }
}

TEST_F(Pvtu, PiecesOfOtherProgramsAreJoinedByCoordinates) {
  const auto piece = [](const std::string& points, const std::string& ghost) {
    return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" "
           "NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
           "format=\"ascii\">" +
           points +
           "</DataArray></Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 "
           "2 "
           "3</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray>"
           "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray></Cells><CellData>"
           "<DataArray type=\"UInt8\" Name=\"vtkGhostType\" format=\"ascii\">" +
           ghost + "</DataArray></CellData></Piece></UnstructuredGrid></VTKFile>";
  };
  put(f / "a.vtu", piece("0 0 0  1 0 0  0 1 0  0 0 1", "0"));
  put(f / "b.vtu", piece("0 0 0  0 1 0  1 0 0  0 0 -1", "0"));
  put(f / "c.vtu", piece("0 0 0  0 1 0  1 0 0  0 0 -1", "1"));
  put(f / "m.pvtu",
      "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece Source=\"a.vtu\"/><Piece "
      "Source=\"b.vtu\"/><Piece Source=\"c.vtu\"/></PUnstructuredGrid></VTKFile>");
  const ReadTetMesh read = read_tet_mesh(f / "m.pvtu");
  EXPECT_EQ(read.mesh.points.size(), 5u);
  EXPECT_EQ(read.mesh.tets.size(), 2u);
}

TEST_F(Pvtu, APieceIsNamedOnce) {
  write(rich_mesh(), 2);
  const std::string good = contents(f / "m.pvtu"), second = "m_1.vtu";
  for (const std::string again : {"m_0.vtu", "./m_0.vtu", ".//m_0.vtu"}) {
    put(f / "m.pvtu", std::string(good).replace(good.find(second), second.size(), again));
    expect_error({"pieces 0 and 1 are the same file", again});
  }
}

TEST_F(Pvtu, CopiesOfAPieceAreRefused) {
  write(rich_mesh(), 3);
  put(f / "m_1.vtu", contents(f / "m_0.vtu"));
  std::filesystem::remove(f / "m_2.vtu");  // is not read any more
  expect_error({"piece 1", "m_1.vtu", "tet number 0 is its own", "piece 0", "m_0.vtu"});
}

TEST_F(Pvtu, ManyPiecesDoNotFillTheMemory) {
  write(rich_mesh(), 3);
  const MemoryLimit limit(1000);
  EXPECT_THROW((void)read_tet_mesh(f / "m.pvtu"), OutputError);
}

TEST_F(Pvtu, PiecesOfOtherFoldersAreRefused) {
  write(rich_mesh(), 2);
  const std::string good = contents(f / "m.pvtu"), second = "m_1.vtu";
  for (const std::string& other : {f / "m_1.vtu", std::string("../m_1.vtu"), std::string("a/../m_1.vtu")}) {
    put(f / "m.pvtu", std::string(good).replace(good.find(second), second.size(), other));
    expect_error({"piece 1", other, "is not a file in its folder"});
  }
}

TEST_F(Pvtu, NumbersThatDoublesCannotHoldAreRefused) {
  const auto piece = [](const std::string& tet, const std::string& node) {
    return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" "
           "NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
           "format=\"ascii\">0 0 0  1 0 0  0 1 0  0 0 1</DataArray></Points><Cells><DataArray "
           "type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray><DataArray "
           "type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray><DataArray type=\"UInt8\" "
           "Name=\"types\" format=\"ascii\">10</DataArray></Cells><PointData><DataArray type=\"Int64\" "
           "Name=\"GlobalNodeId\" format=\"ascii\">0 1 2 " +
           node +
           "</DataArray></PointData><CellData><DataArray type=\"Int64\" Name=\"GlobalCellId\" "
           "format=\"ascii\">" +
           tet + "</DataArray></CellData></Piece></UnstructuredGrid></VTKFile>";
  };
  put(f / "m.pvtu",
      "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece Source=\"a.vtu\"/>"
      "</PUnstructuredGrid></VTKFile>");
  const std::string largest = "9007199254740991";
  put(f / "a.vtu", piece(largest, "-" + largest));
  EXPECT_EQ(read_tet_mesh(f / "m.pvtu").mesh.tets.size(), 1u);
  for (const std::string bad : {"9007199254740992", "-9007199254740993", "9223372036854775807"}) {
    put(f / "a.vtu", piece(bad, "3"));
    expect_error({"piece 0", "a.vtu", "item 0 of \"GlobalCellId\"", "2^53"});
    put(f / "a.vtu", piece("0", bad));
    expect_error({"piece 0", "item 3 of \"GlobalNodeId\"", "2^53"});
  }
}

TEST_F(Pvtu, OtherFilesAreRefused) {
  for (const auto& [text, said] : std::initializer_list<std::pair<std::string, std::string>>{
           {"", "not XML"},
           {"<a/>", "VTKFile"},
           {"<VTKFile type=\"UnstructuredGrid\"/>", "PUnstructuredGrid"},
           {"<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid/></VTKFile>", "no Piece"},
           {"<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece/></PUnstructuredGrid></VTKFile>",
            "no Source"}}) {
    put(f / "m.pvtu", text);
    expect_error({said});
  }
}

}  // namespace
}  // namespace tetwright::pvtu_test

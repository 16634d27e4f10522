// SPDX-License-Identifier: Apache-2.0

// Meshes in parts in .msh, .xdmf and .vtkhdf files; tests/interop has them read by other programs.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <variant>

#include "common/io/encodings/hdf5_image.h"
#include "common/io/tets/msh4_pieces.h"
#include "common/io/tets/vtkhdf.h"
#include "common/samples/samples.h"
#include "tests/common/temporary_folder.h"
#include "tetwright/error.h"
#include "tetwright/file_sharing.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::parts_test {
namespace {

TetMesh sample_mesh() {
  TetMesh mesh = std::get<TetMesh>(make_sample("two_materials"));
  mesh.interfaces = find_interfaces(mesh);
  MeshField field{.name = "a/b", .values = {}};
  for (std::size_t p = 0; p < mesh.points.size(); ++p) field.values.push_back(static_cast<double>(p) / 7);
  mesh.point_fields = {field};
  return mesh;
}

TetPartition halves(const TetMesh& mesh) {
  TetPartition partition{.parts = 2, .part_of = {}};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) partition.part_of.push_back(t % 10 < 4 ? 1 : 0);
  return partition;
}

TEST(PartsInXdmf, TetsOfAPartAreInSuccessionWithItsNumber) {
  const TemporaryFolder f;
  const TetMesh mesh = sample_mesh();
  write_tet_mesh(mesh, halves(mesh), f / "m.xdmf");
  const ReadTetMesh back = read_tet_mesh(f / "m.xdmf");
  ASSERT_EQ(back.mesh.cell_fields.size(), 1u);
  EXPECT_EQ(back.mesh.cell_fields[0].name, "partition");
  EXPECT_TRUE(std::is_sorted(back.mesh.cell_fields[0].values.begin(), back.mesh.cell_fields[0].values.end()));
  EXPECT_EQ(back.mesh.tets.size(), mesh.tets.size());
  EXPECT_TRUE(check_mesh(back.mesh).empty());
  const MeshStatistics before = mesh_statistics(mesh, 0.1), after = mesh_statistics(back.mesh, 0.1);
  EXPECT_NEAR(after.volume, before.volume, 1e-12);
  EXPECT_EQ(after.materials.size(), before.materials.size());
}

TEST(PartsInXdmf, AFieldWithTheNameOfThePartsIsRenamedAndSaid) {
  const TemporaryFolder f;
  TetMesh mesh = sample_mesh();
  mesh.cell_fields.push_back({"partition", 1, true, std::vector<double>(mesh.tets.size(), 5)});
  write_tet_mesh(mesh, halves(mesh), f / "m.xdmf");
  const std::vector<MeshField> fields = read_tet_mesh(f / "m.xdmf").mesh.cell_fields;
  ASSERT_EQ(fields.size(), 2u);
  EXPECT_EQ(fields[1].name, "partition_2");
  EXPECT_EQ(fields[1].values, mesh.cell_fields[0].values);
  const NameChanges changes = written_name_changes(mesh, f / "m.xdmf", "", 2);
  ASSERT_EQ(changes.fields.size(), 1u);
  EXPECT_EQ(changes.fields[0].written, "\"partition_2\"");
  EXPECT_TRUE(written_name_changes(mesh, f / "m.xdmf").fields.empty());
}

TEST(PartsInMsh, EachFileHasItsTetsItsGhostsAndTheirOwners) {
  const TemporaryFolder f;
  const TetMesh mesh = sample_mesh();
  const TetPartition partition = halves(mesh);
  const PartitionStatistics statistics = partition_statistics(mesh, partition);
  write_tet_mesh(mesh, partition, f / "m.msh");
  EXPECT_EQ(f.entries(), 2u);
  std::size_t triangles = 0;
  for (PartNumber part = 0; part < 2; ++part) {
    std::istringstream file(contents(f / ("m_" + std::to_string(part + 1) + ".msh")));
    std::size_t tets = 0, ghosts = 0;
    for (std::string line; std::getline(file, line);) {
      if (line == "$PartitionedEntities") {
        std::size_t parts = 0;
        file >> parts;
        EXPECT_EQ(parts, 2u);
      }
      if (line == "$Elements") {
        std::size_t blocks, elements, smallest, largest;
        file >> blocks >> elements >> smallest >> largest;
        for (std::size_t b = 0; b < blocks; ++b) {
          std::size_t dimension, tag, type, count;
          file >> dimension >> tag >> type >> count;
          std::getline(file, line);
          (dimension == 3 ? tets : triangles) += count;
          for (std::size_t e = 0; e < count; ++e) std::getline(file, line);
        }
      }
      if (line == "$GhostElements") {
        file >> ghosts;
        std::getline(file, line);
        for (std::size_t g = 0; g < ghosts; ++g) {
          std::size_t tet, owner, count, of;
          file >> tet >> owner >> count >> of;
          EXPECT_EQ(partition.of(tet - 1), owner - 1);
          EXPECT_EQ(of, part + 1);
        }
      }
    }
    EXPECT_EQ(ghosts, statistics.parts[part].ghosts);
    EXPECT_EQ(tets, statistics.parts[part].tets + ghosts);
  }
  EXPECT_EQ(triangles, mesh.interfaces.size());
}

/// Expects the same bytes if every second piece is written from its bytes alone.
void expect_shared(const TetMesh& mesh, const MidsideNodes* midside, const TetPartition& partition,
                   const std::string& file, const std::string& format) {
  const TemporaryFolder alone, shared;
  write_tet_mesh({mesh, midside}, partition, alone / file, nullptr, format);
  std::size_t ordered = 0;
  const FileSharing share{[&](const PiecesToWrite& pieces) {
    EXPECT_EQ(pieces.count, partition.parts);
    for (std::size_t p = pieces.count; p-- > 0;) {
      if (p % 2 == 0) {
        pieces.here(p);
        continue;
      }
      const std::string order = pieces.order(p);
      write_ordered_piece(order);
      ++ordered;
      EXPECT_THROW(write_ordered_piece(std::string_view(order).substr(0, order.size() - 1)), InputError);
    }
  }};
  write_tet_mesh({mesh, midside}, partition, shared / file, nullptr, format, &share);
  EXPECT_EQ(ordered, partition.parts / 2);
  EXPECT_EQ(shared.entries(), alone.entries());
  for (const std::string& name : files_of_tet_mesh(alone / file, format, partition.parts)) {
    const std::string last = std::filesystem::path(name).filename().string();
    EXPECT_TRUE(contents(shared / last) == contents(alone / last)) << last;
  }
}

TEST(PartsInFiles, PiecesAreWrittenByOthers) {
  TetMesh mesh = sample_mesh();
  mesh.patch_groups[{mesh.interfaces[0].pair(), 0}] = {7, "side"};
  mesh.material_names = {{mesh.materials[0], "first"}};
  mesh.cell_fields.push_back({"whole", 2, true, std::vector<double>(2 * mesh.tets.size(), 5)});
  TetPartition partition{.parts = 5, .part_of = {}};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    partition.part_of.push_back(static_cast<PartNumber>(t * 5 / mesh.tets.size()));
  const MidsideNodes midside = straight_midside_nodes(mesh);
  for (const MidsideNodes* nodes : {static_cast<const MidsideNodes*>(nullptr), &midside}) {
    expect_shared(mesh, nodes, partition, "m.pvtu", "");
    expect_shared(mesh, nodes, partition, "m.msh", "");
    expect_shared(mesh, nodes, partition, "m.msh", "msh41-binary");
  }
}

TEST(PartsInFiles, NothingIsLeftIfAPieceFails) {
  const TemporaryFolder f;
  const TetMesh mesh = sample_mesh();
  const FileSharing share{[](const PiecesToWrite& pieces) {
    write_ordered_piece(pieces.order(0));
    throw OutputError("the disk is full");
  }};
  EXPECT_THROW(write_tet_mesh(mesh, halves(mesh), f / "m.pvtu", nullptr, "", &share), OutputError);
  EXPECT_EQ(f.entries(), 0u);
}

TEST(PartsInMsh, FilesAreNumberedFromOne) {
  EXPECT_EQ(files_of_msh_pieces("a/m.msh", 2), (std::vector<std::string>{"a/m_1.msh", "a/m_2.msh"}));
}

TEST(PartsInVtkHdf, PiecesAreInSuccession) {
  const TemporaryFolder f;
  const TetMesh mesh = sample_mesh();
  const TetPartition partition = halves(mesh);
  const PartitionStatistics statistics = partition_statistics(mesh, partition);
  write_tet_mesh(mesh, partition, f / "m.vtkhdf");
  const Hdf5Reader file(contents(f / "m.vtkhdf"), "m");
  const auto numbers = [&](const std::string& name) { return file.numbers("/VTKHDF/" + name, 1 << 20); };
  std::vector<double> cells;
  std::size_t all = 0;
  for (const PartSize& part : statistics.parts) {
    cells.push_back(static_cast<double>(part.tets + part.ghosts));
    all += part.tets + part.ghosts;
  }
  EXPECT_EQ(numbers("NumberOfCells"), cells);
  EXPECT_EQ(numbers("Offsets").size(), all + 2);
  EXPECT_EQ(numbers("Connectivity").size(), 4 * all);
  const std::vector<double> ghosts = numbers("CellData/vtkGhostType"),
                            tets = numbers("CellData/GlobalCellId"),
                            points = numbers("PointData/GlobalNodeId"), values = numbers("PointData/a_b");
  EXPECT_EQ(static_cast<std::size_t>(std::count(ghosts.begin(), ghosts.end(), 0)), mesh.tets.size());
  for (std::size_t c = 0; c < all; ++c) {
    const PartNumber part = static_cast<double>(c) < cells[0] ? 0 : 1;
    EXPECT_EQ(ghosts[c] == 0, partition.of(static_cast<std::size_t>(tets[c])) == part);
  }
  for (std::size_t p = 0; p < points.size(); ++p) EXPECT_EQ(values[p], points[p] / 7);
  EXPECT_EQ(numbers("CellData/face_groups").size(), 4 * all);
}

TEST(PartsInVtkHdf, EqualMeshesGiveEqualBytes) {
  const TetMesh mesh = sample_mesh();
  const TetPartition partition = halves(mesh);
  const MeshPieces pieces(mesh, nullptr, partition);
  const auto bytes = [&] {
    VtkHdfWriter writer(pieces.whole());
    for (PartNumber part = 0; part < 2; ++part) writer.add(pieces.piece(part));
    Hdf5Image file;
    writer.write(file);
    return file.bytes();
  };
  EXPECT_EQ(bytes(), bytes());
}

TEST(Parts, OtherFormatsAreRefusedWithThoseThatCan) {
  const TetMesh mesh = sample_mesh();
  for (const TetFormatInfo& format : written_tet_formats()) {
    if (format.parts) continue;
    try {
      (void)written_tet_format("m" + format.extension, format.name, 2);
      FAIL() << format.name;
    } catch (const UsageError& e) {
      EXPECT_NE(std::string(e.what()).find(".pvtu .vtkhdf .msh .xdmf"), std::string::npos) << e.what();
    }
  }
  EXPECT_EQ(written_tet_format("m.msh", "", 2).name, "msh41");
  EXPECT_EQ(written_tet_format("m.msh").name, "msh22");
}

}  // namespace
}  // namespace tetwright::parts_test

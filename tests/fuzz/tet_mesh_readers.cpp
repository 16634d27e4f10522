// SPDX-License-Identifier: Apache-2.0

// Fuzzes the readers of tet meshes: each must return a mesh with indices in range and fields of the right
// size, or throw an InputError. The mesh must survive a round trip through a writer, and functions for meshes
// of other programs must accept it.
#include <utility>

#include "common/io/tets/abaqus.h"
#include "common/io/tets/medit.h"
#include "common/io/tets/medit_binary.h"
#include "common/io/tets/msh.h"
#include "common/io/tets/nastran.h"
#include "common/io/tets/pvtu.h"
#include "common/io/tets/tet_formats.h"
#include "common/io/tets/tetgen.h"
#include "common/io/tets/vtk.h"
#include "common/io/tets/vtu.h"
#include "common/io/tets/xdmf.h"
#include "tests/fuzz/targets.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::fuzz {
namespace {

using Read = ReadTetMesh (*)(std::string_view, const std::string&, const ReadTetMeshOptions&);
using Write = std::string (*)(const MeshToWrite&);

void check_fields(const std::vector<MeshField>& fields, std::size_t items) {
  for (const MeshField& field : fields) {
    TETWRIGHT_CHECK(field.components >= 1 && !field.name.empty());
    TETWRIGHT_CHECK(field.values.size() == items * static_cast<std::size_t>(field.components));
  }
}

void check_mesh_read(const TetMesh& mesh) {
  TETWRIGHT_CHECK(!mesh.tets.empty());
  TETWRIGHT_CHECK(mesh.materials.size() == mesh.tets.size());
  for (const Vec3& p : mesh.points) TETWRIGHT_CHECK(p.allFinite());
  for (const Tet& t : mesh.tets)
    for (Index v : t) TETWRIGHT_CHECK(v < mesh.points.size());
  check_fields(mesh.point_fields, mesh.points.size());
  check_fields(mesh.cell_fields, mesh.tets.size());
}

/// Reads a mesh like read_tet_mesh().
TetMesh mesh_in(std::string_view bytes, Read read) {
  ReadTetMesh result = read(bytes, "fuzz", {});
  for (const Dropped& dropped : result.dropped) TETWRIGHT_CHECK(!dropped.what.empty() && dropped.count > 0);
  drop_names_of_cohesive(result.mesh);
  return std::move(result.mesh);
}

void run(std::string_view bytes, Read read, Write write, Read read_back) {
  try {
    TetMesh mesh = mesh_in(bytes, read);
    check_mesh_read(mesh);
    const std::string written = write(mesh);
    const TetMesh back = mesh_in(written, read_back);
    TETWRIGHT_CHECK(back.points == mesh.points);
    TETWRIGHT_CHECK(back.tets == mesh.tets);
    TETWRIGHT_CHECK(back.materials == mesh.materials);
    TETWRIGHT_CHECK(back.space == mesh.space);
    constexpr std::size_t max_tets = 100;  // maximum size of meshes passed to further functions
    if (mesh.tets.size() >= max_tets) return;
    // A format may change names and components in the first round trip, but not in the second.
    const std::string again = write(back);
    TETWRIGHT_CHECK(write(mesh_in(again, read_back)) == again);
    (void)check_mesh(mesh);
    (void)mesh_statistics(mesh);
    TETWRIGHT_CHECK(topology_differences(topology(mesh), topology(back)).empty());
    (void)make_coherent(mesh);
    if (!mesh.tets.empty()) {
      check_mesh_read(mesh);
      transfer_fields(back, mesh);
      check_mesh_read(mesh);
    }
  } catch (const InputError&) {
  }
}

/// Round trip through VTU.
void run(std::string_view bytes, Read read) { run(bytes, read, write_vtu, read_vtu); }

/// Reads files of points, tets and faces from one text, separated by lines of equal signs; faces may be
/// missing.
ReadTetMesh read_tetgen_files(std::string_view bytes, const std::string& name, const ReadTetMeshOptions&) {
  constexpr std::string_view between = "=====\n";
  const auto next = [&] {
    const std::size_t at = bytes.find(between);
    const std::string_view part = bytes.substr(0, at);
    bytes = at == std::string_view::npos ? "" : bytes.substr(at + between.size());
    return part;
  };
  const std::string_view node = next(), ele = next();
  const std::optional<NamedBytes> face =
      bytes.empty() ? std::nullopt : std::optional(NamedBytes{bytes, name});
  return read_tetgen({node, name}, {ele, name}, face);
}

/// Reads a file whose numbers are in the text, without another file.
ReadTetMesh read_xdmf_alone(std::string_view bytes, const std::string& name, const ReadTetMeshOptions&) {
  return read_xdmf(bytes, name,
                   [](const std::string& path) -> std::string { throw InputError(path + ": is not there"); });
}

/// Reads a .pvtu file and its pieces from one text, separated by lines of equal signs; the pieces are called
/// 0, 1 and so on.
ReadTetMesh read_pvtu_parts(std::string_view bytes, const std::string& name, const ReadTetMeshOptions&) {
  constexpr std::string_view between = "=====\n";
  const auto part = [&](std::size_t number) {
    std::string_view rest = bytes;
    for (; number > 0; --number) {
      const std::size_t at = rest.find(between);
      if (at == std::string_view::npos) throw InputError(name + ": there is no such piece");
      rest.remove_prefix(at + between.size());
    }
    return std::string(rest.substr(0, rest.find(between)));
  };
  return read_pvtu(name, {}, [&](const std::string& path) {
    return path == name ? part(0) : part(path.size() == 1 && path[0] >= '0' ? path[0] - '0' + 1 : 1000);
  });
}

using Bytes = std::string_view;
constexpr Target targets[] = {
    {"vtu", [](Bytes b) { run(b, read_vtu); }},
    {"msh", [](Bytes b) { run(b, read_msh, write_msh, read_msh); }},
    {"medit", [](Bytes b) { run(b, read_medit, write_medit, read_medit); }},
    {"medit_binary", [](Bytes b) { run(b, read_medit_binary); }},
    {"vtk", [](Bytes b) { run(b, read_vtk); }},
    {"tetgen", [](Bytes b) { run(b, read_tetgen_files); }},
    {"abaqus", [](Bytes b) { run(b, read_abaqus); }},
    {"nastran", [](Bytes b) { run(b, read_nastran); }},
    {"pvtu", [](Bytes b) { run(b, read_pvtu_parts); }},
    {"xdmf", [](Bytes b) { run(b, read_xdmf_alone); }},
};

}  // namespace

std::span<const Target> tet_mesh_targets() { return targets; }

}  // namespace tetwright::fuzz

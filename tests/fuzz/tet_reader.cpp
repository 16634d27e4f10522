// Fuzzes a reader of tet meshes: it must return a mesh whose indices are in range and whose fields have the
// right sizes, or throw an InputError. The mesh must survive a round trip through the writer, and the
// functions that work on meshes of other programs must accept it.
#include <cstdint>

#include BACK_HEADER
#include FORMAT_HEADER
#include "common/error.h"
#include "common/mesh/field_transfer.h"
#include "common/mesh/foreign_mesh.h"
#include "common/mesh/mesh_check.h"
#include "common/mesh/mesh_statistics.h"
#include "common/mesh/topology.h"
#include "tests/fuzz/names.h"

namespace {

using namespace tetwright;

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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const ReadTetMesh read = READ_FORMAT({reinterpret_cast<const char*>(data), size}, "fuzz");
    for (const Dropped& dropped : read.dropped) TETWRIGHT_CHECK(!dropped.what.empty() && dropped.count > 0);
    TetMesh mesh = read.mesh;
    check_mesh_read(mesh);
    const std::string written = WRITE_BACK(mesh);
    const TetMesh back = READ_BACK(written, "fuzz").mesh;
    TETWRIGHT_CHECK(back.points == mesh.points);
    TETWRIGHT_CHECK(back.tets == mesh.tets);
    TETWRIGHT_CHECK(back.materials == mesh.materials);
    if (mesh.tets.size() < 100) {
      // A format may change names and components in the first round trip, but not in the second.
      const std::string again = WRITE_BACK(back);
      TETWRIGHT_CHECK(WRITE_BACK(READ_BACK(again, "fuzz").mesh) == again);
      (void)check_mesh(mesh);
      (void)mesh_statistics(mesh);
      TETWRIGHT_CHECK(topology_differences(topology(mesh), topology(back)).empty());
      (void)make_coherent(mesh);
      if (!mesh.tets.empty()) {
        check_mesh_read(mesh);
        transfer_fields(back, mesh);
        check_mesh_read(mesh);
      }
    }
  } catch (const InputError&) {
  }
  return 0;
}

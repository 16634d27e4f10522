// Any bytes must give a tet mesh whose indices are in range and whose fields fit, or an InputError; the mesh
// must come back from what the writer makes of it, and what works on read meshes must cope with whatever it
// is.
#include <cstdint>

#include BACK_HEADER
#include FORMAT_HEADER
#include "common/error.h"
#include "common/field_transfer.h"
#include "common/foreign_mesh.h"
#include "common/mesh_check.h"
#include "common/mesh_statistics.h"
#include "common/topology.h"
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
    TetMesh mesh = READ_FORMAT({reinterpret_cast<const char*>(data), size}, "fuzz").mesh;
    check_mesh_read(mesh);
    const std::string written = WRITE_BACK(mesh);
    const TetMesh back = READ_BACK(written, "fuzz").mesh;
    TETWRIGHT_CHECK(back.points == mesh.points);
    TETWRIGHT_CHECK(back.tets == mesh.tets);
    TETWRIGHT_CHECK(back.materials == mesh.materials);
    if (mesh.tets.size() < 100) {
      // Formats bend names and components once, not again and again.
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

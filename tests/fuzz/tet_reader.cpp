// Any bytes must give a tet mesh whose indices are in range, or an InputError; the mesh must come back from
// what the writer makes of it, and the check must cope with whatever it is.
#include <cstdint>

#include FORMAT_HEADER
#include "common/error.h"
#include "common/mesh_check.h"
#include "common/mesh_statistics.h"
#include "common/topology.h"
#include "tests/fuzz/names.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetwright;
  try {
    const TetMesh mesh = READ_FORMAT({reinterpret_cast<const char*>(data), size}, "fuzz").mesh;
    TETWRIGHT_CHECK(!mesh.tets.empty());
    TETWRIGHT_CHECK(mesh.materials.size() == mesh.tets.size());
    for (const Vec3& p : mesh.points) TETWRIGHT_CHECK(p.allFinite());
    for (const Tet& t : mesh.tets)
      for (Index v : t) TETWRIGHT_CHECK(v < mesh.points.size());
    const TetMesh back = READ_FORMAT(WRITE_FORMAT(mesh), "fuzz").mesh;
    TETWRIGHT_CHECK(back.points == mesh.points);
    TETWRIGHT_CHECK(back.tets == mesh.tets);
    TETWRIGHT_CHECK(back.materials == mesh.materials);
    if (mesh.tets.size() < 100) {
      (void)check_mesh(mesh);
      (void)mesh_statistics(mesh);
      TETWRIGHT_CHECK(topology_differences(topology(mesh), topology(back)).empty());
    }
  } catch (const InputError&) {
  }
  return 0;
}

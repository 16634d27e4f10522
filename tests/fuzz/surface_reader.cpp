// Fuzzes a reader of surfaces: it must return a surface whose indices are in range, or throw an InputError.
// The surface must survive a round trip through a writer. Where points may have fields, reading them must
// give the same surface and fields of the right size.
#include <cstdint>

#include BACK_HEADER
#include FORMAT_HEADER
#include "common/error.h"
#include "tests/fuzz/names.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tetwright;
  try {
    std::vector<Dropped> dropped;
    const TriangleMesh mesh = READ_FORMAT({reinterpret_cast<const char*>(data), size}, "fuzz", &dropped);
    for (const Dropped& d : dropped) TETWRIGHT_CHECK(!d.what.empty() && d.count > 0);
    TETWRIGHT_CHECK(!mesh.triangles.empty());
    for (const Vec3& p : mesh.points) TETWRIGHT_CHECK(p.allFinite());
    for (const Triangle& t : mesh.triangles)
      for (Index v : t) TETWRIGHT_CHECK(v < mesh.points.size());
    const TriangleMesh back = READ_BACK(WRITE_BACK(mesh), "fuzz");
    TETWRIGHT_CHECK(back.triangles.size() == mesh.triangles.size());
    // Compared by position, since STL keeps neither the numbers of points nor unused points.
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        TETWRIGHT_CHECK(back.points[back.triangles[t][k]] == mesh.points[mesh.triangles[t][k]]);
  } catch (const InputError&) {
  }
#ifdef HAS_FIELDS
  try {
    const SurfaceWithFields read = READ_WITH_FIELDS({reinterpret_cast<const char*>(data), size}, "fuzz");
    TETWRIGHT_CHECK(read.surface.triangles ==
                    READ_FORMAT({reinterpret_cast<const char*>(data), size}, "fuzz").triangles);
    for (const MeshField& field : read.point_fields) {
      TETWRIGHT_CHECK(field.components >= 1 && !field.name.empty());
      TETWRIGHT_CHECK(field.values.size() ==
                      read.surface.points.size() * static_cast<std::size_t>(field.components));
    }
  } catch (const InputError&) {
  }
#endif
  return 0;
}

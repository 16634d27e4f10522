// SPDX-License-Identifier: Apache-2.0

// Fuzzes the readers of surfaces: each must return a surface with indices in range, or throw an InputError.
// The surface must survive a round trip through a writer. If points may have fields, reading these must give
// the same surface and fields of the right size.
#include "common/io/surfaces/3mf.h"
#include "common/io/surfaces/glb.h"
#include "common/io/surfaces/obj.h"
#include "common/io/surfaces/off.h"
#include "common/io/surfaces/ply.h"
#include "common/io/surfaces/stl.h"
#include "common/io/surfaces/vtp.h"
#include "common/io/tets/vtk.h"
#include "tests/common/io/zip_of.h"
#include "tests/fuzz/targets.h"
#include "tetwright/error.h"

namespace tetwright::fuzz {
namespace {

using Read = TriangleMesh (*)(std::string_view, const std::string&, std::vector<Dropped>*);
using ReadWithFields = SurfaceWithFields (*)(std::string_view, const std::string&);
using Write = std::string (*)(const TriangleMesh&);

void run(std::string_view bytes, Read read, Write write, Read read_back) {
  try {
    std::vector<Dropped> dropped;
    const TriangleMesh mesh = read(bytes, "fuzz", &dropped);
    for (const Dropped& d : dropped) TETWRIGHT_CHECK(!d.what.empty() && d.count > 0);
    TETWRIGHT_CHECK(!mesh.triangles.empty());
    for (const Vec3& p : mesh.points) TETWRIGHT_CHECK(p.allFinite());
    for (const Triangle& t : mesh.triangles)
      for (Index v : t) TETWRIGHT_CHECK(v < mesh.points.size());
    const TriangleMesh back = read_back(write(mesh), "fuzz", nullptr);
    TETWRIGHT_CHECK(back.triangles.size() == mesh.triangles.size());
    // Compared by position, since STL keeps neither point numbers nor unused points.
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        TETWRIGHT_CHECK(back.points[back.triangles[t][k]] == mesh.points[mesh.triangles[t][k]]);
  } catch (const InputError&) {
  }
}

/// For formats that can only be read: round trip through PLY.
void run(std::string_view bytes, Read read) { run(bytes, read, write_ply, read_ply); }

void run_fields(std::string_view bytes, ReadWithFields read_with_fields, Read read) {
  try {
    const SurfaceWithFields result = read_with_fields(bytes, "fuzz");
    TETWRIGHT_CHECK(result.surface.triangles == read(bytes, "fuzz", nullptr).triangles);
    for (const MeshField& field : result.point_fields) {
      TETWRIGHT_CHECK(field.components >= 1 && !field.name.empty());
      TETWRIGHT_CHECK(field.values.size() ==
                      result.surface.points.size() * static_cast<std::size_t>(field.components));
    }
  } catch (const InputError&) {
  }
}

/// Reads the bytes as the model in a .3mf file; a damaged archive would fail at its checksum.
TriangleMesh read_3mf_model(std::string_view bytes, const std::string& name, std::vector<Dropped>* dropped) {
  return read_3mf(zip_of({{"_rels/.rels", relationships_of_3mf}, {"3D/a.model", std::string(bytes)}}), name,
                  dropped);
}

using Bytes = std::string_view;
constexpr Target targets[] = {
    {"ply", [](Bytes b) { run(b, read_ply), run_fields(b, read_ply_with_fields, read_ply); }},
    {"obj", [](Bytes b) { run(b, read_obj, write_obj, read_obj); }},
    {"stl", [](Bytes b) { run(b, read_stl, write_stl, read_stl); }},
    {"off", [](Bytes b) { run(b, read_off, write_off, read_off); }},
    {"vtp", [](Bytes b) { run(b, read_vtp), run_fields(b, read_vtp_with_fields, read_vtp); }},
    {"vtk_surface", [](Bytes b) { run(b, read_vtk_surface); }},
    {"3mf", [](Bytes b) { run(b, read_3mf); }},
    {"3mf_model", [](Bytes b) { run(b, read_3mf_model); }},
    {"glb", [](Bytes b) { run(b, read_glb); }},
};

}  // namespace

std::span<const Target> surface_targets() { return targets; }

}  // namespace tetwright::fuzz

#include "common/samples.h"

#include <numbers>

#include "common/mesh_check.h"
#include "common/surface_chains.h"
#include "tests/common/formats/expect_error.h"
#include "tests/common/formats/file_test.h"

namespace tetwright {
namespace {

using Samples = FileTest;

double volume(const TriangleMesh& mesh) {
  double v = 0;
  for (const Triangle& t : mesh.triangles)
    v += mesh.points[t[0]].dot(mesh.points[t[1]].cross(mesh.points[t[2]])) / 6;
  return v;
}

TEST_F(Samples, VolumesAreThoseOfTheirShapesAndPositive) {
  const auto of = [](const char* name) { return volume(std::get<TriangleMesh>(make_sample(name))); };
  const double pi = std::numbers::pi;
  EXPECT_NEAR(of("sphere"), 4 * pi / 3, 0.01);
  EXPECT_NEAR(of("torus"), 2 * pi * pi * 0.16, 0.05);
  EXPECT_NEAR(of("cube"), 8, 1e-12);
  EXPECT_NEAR(of("two_spheres"), 4 * pi / 3 * (1 + 0.421875), 0.04);
  EXPECT_GT(of("knot"), 10);
}

TEST_F(Samples, ClosedButForTheOpenSphere) {
  for (const std::string& name : sample_names()) {
    if (sample_kind(name) != FileKind::surface) continue;
    const auto mesh = std::get<TriangleMesh>(make_sample(name));
    std::size_t open = 0;
    for (const SurfaceEdge& e : surface_chains(mesh.triangles).edges) open += e.count != 2;
    EXPECT_EQ(open > 0, name == "open_sphere") << name;
  }
}

TEST_F(Samples, EachIsWrittenAndReadInItsFormats) {
  for (const std::string& name : sample_names()) {
    const bool surface = sample_kind(name) == FileKind::surface;
    for (const char* extension : {".ply", ".obj", ".off", ".stl", ".vtu", ".msh", ".mesh"}) {
      const std::string out = path(name + extension);
      if (surface != (file_kind(out) == FileKind::surface)) {
        EXPECT_NE(error_of<UsageError>([&] { write_sample(name, out); }).find("known are"),
                  std::string::npos);
        EXPECT_FALSE(std::filesystem::exists(out));
        continue;
      }
      write_sample(name, out);
      if (surface)
        EXPECT_EQ(read_surface(out).triangles.size(),
                  std::get<TriangleMesh>(make_sample(name)).triangles.size());
      else
        EXPECT_EQ(read_tet_mesh(out).mesh.tets, std::get<TetMesh>(make_sample(name)).tets);
    }
  }
}

TEST_F(Samples, UnknownNamesListTheKnown) {
  const std::string message = error_of<UsageError>([&] { write_sample("bunny\n", path("a.ply")); });
  EXPECT_NE(message.find("\"bunny?\""), std::string::npos) << message;
  for (const std::string& name : sample_names()) EXPECT_NE(message.find(name), std::string::npos);
}

}  // namespace
}  // namespace tetwright

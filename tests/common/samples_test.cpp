#include "common/samples.h"

#include <map>
#include <numbers>

#include "common/mesh_check.h"
#include "common/surface_chains.h"
#include "tests/common/formats/expect_error.h"
#include "tests/common/formats/file_test.h"

namespace tetwright::samples_test {
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
    const FileKind kind = sample_kind(name);
    for (const char* extension : {".ply", ".obj", ".off", ".stl", ".vtu", ".msh", ".mesh", ".nrrd"}) {
      const std::string out = path(name + extension);
      if (kind != file_kind(out)) {
        EXPECT_NE(error_of<UsageError>([&] { write_sample(name, out); }).find("known are"),
                  std::string::npos);
        EXPECT_FALSE(std::filesystem::exists(out));
        continue;
      }
      write_sample(name, out);
      if (kind == FileKind::surface)
        EXPECT_EQ(read_surface(out).triangles.size(),
                  std::get<TriangleMesh>(make_sample(name)).triangles.size());
      else if (kind == FileKind::tet_mesh)
        EXPECT_EQ(read_tet_mesh(out).mesh.tets, std::get<TetMesh>(make_sample(name)).tets);
      else
        EXPECT_EQ(read_label_volume(out).labels, std::get<LabelVolume>(make_sample(name)).labels);
    }
  }
}

TEST_F(Samples, OrgansTouchInsideASkin) {
  const auto v = std::get<LabelVolume>(make_sample("organs"));
  ASSERT_EQ(v.labels.size(), 48u * 48 * 48);
  EXPECT_EQ(v.to_input(Vec3::Constant(23.5)), Vec3::Zero());
  // What the bits are built from: any change of them shows here.
  std::map<MaterialTag, int> counts;
  for (const MaterialTag label : v.labels) ++counts[label];
  EXPECT_EQ(counts,
            (std::map<MaterialTag, int>{{0, 72344}, {1, 26432}, {2, 3977}, {3, 1906}, {4, 4480}, {5, 1453}}));
  int touching = 0;
  for (std::size_t i = 0; i + 1 < v.labels.size(); ++i) touching += v.labels[i] == 2 && v.labels[i + 1] == 3;
  EXPECT_EQ(touching, 82);
}

TEST_F(Samples, UnknownNamesListTheKnown) {
  const std::string message = error_of<UsageError>([&] { write_sample("bunny\n", path("a.ply")); });
  EXPECT_NE(message.find("\"bunny?\""), std::string::npos) << message;
  for (const std::string& name : sample_names()) EXPECT_NE(message.find(name), std::string::npos);
}

}  // namespace
}  // namespace tetwright::samples_test

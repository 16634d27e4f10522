// SPDX-License-Identifier: Apache-2.0
#include "common/samples/samples.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "common/mesh/surface_chains.h"
#include "tests/common/io/expect_error.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::samples_test {
namespace {

double volume(const TriangleMesh& mesh) {
  double v = 0;
  for (const Triangle& t : mesh.triangles)
    v += mesh.points[t[0]].dot(mesh.points[t[1]].cross(mesh.points[t[2]])) / 6;
  return v;
}

TEST(Samples, VolumesAreThoseOfTheirShapesAndPositive) {
  const auto of = [](const char* name) { return volume(std::get<TriangleMesh>(make_sample(name))); };
  const double pi = std::numbers::pi;
  EXPECT_NEAR(of("sphere"), 4 * pi / 3, 0.01);
  EXPECT_NEAR(of("torus"), 2 * pi * pi * 0.16, 0.05);
  EXPECT_NEAR(of("cube"), 8, 1e-12);
  EXPECT_NEAR(of("two_spheres"), 4 * pi / 3 * (1 + 0.421875), 0.04);
  EXPECT_GT(of("knot"), 10);
  EXPECT_NEAR(of("lead"), 38 * (9 - 2 * 0.875 * 0.875), 1e-12);
}

TEST(Samples, ClosedButForTheOpenSphere) {
  for (const std::string& name : sample_names()) {
    const Sample sample = make_sample(name);
    const auto* mesh = std::get_if<TriangleMesh>(&sample);
    if (!mesh) continue;
    std::size_t open = 0;
    for (const SurfaceEdge& e : surface_chains(mesh->triangles).edges) open += e.count != 2;
    EXPECT_EQ(open > 0, name == "open_sphere") << name;
  }
}

TEST(Samples, TetMeshesAreValid) {
  for (const std::string& name : sample_names()) {
    const Sample sample = make_sample(name);
    if (const auto* mesh = std::get_if<TetMesh>(&sample)) {
      EXPECT_TRUE(check_mesh(*mesh).empty()) << name;
    }
  }
}

TEST(Samples, OrgansTouchInsideASkin) {
  const auto v = std::get<LabelVolume>(make_sample("organs"));
  ASSERT_EQ(v.labels.size(), 48u * 48 * 48);
  EXPECT_EQ(v.to_input(Vec3::Constant(23.5)), Vec3::Zero());
  // Every change of these ingredients changes the bits.
  std::map<MaterialTag, int> counts;
  for (const MaterialTag label : v.labels) ++counts[label];
  EXPECT_EQ(counts,
            (std::map<MaterialTag, int>{{0, 72344}, {1, 26432}, {2, 3977}, {3, 1906}, {4, 4480}, {5, 1453}}));
  int touching = 0;
  for (std::size_t i = 0; i + 1 < v.labels.size(); ++i) touching += v.labels[i] == 2 && v.labels[i + 1] == 3;
  EXPECT_EQ(touching, 82);
}

TEST(Samples, UnknownNamesListTheKnown) {
  const std::string message = error_of<UsageError>([&] { make_sample("bunny\n"); });
  EXPECT_NE(message.find("\"bunny?\""), std::string::npos) << message;
  for (const std::string& name : sample_names()) EXPECT_NE(message.find(name), std::string::npos);
}

}  // namespace
}  // namespace tetwright::samples_test

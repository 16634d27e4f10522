// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/surface_chains.h"

#include <gtest/gtest.h>

#include "common/samples/samples.h"

namespace tetwright::surface_chains_test {
namespace {

TEST(SurfaceChains, ClosedSurfacesHaveTheirEulerNumbers) {
  const std::tuple<const char*, std::size_t, std::ptrdiff_t> expected[] = {
      {"sphere", 1, 2},      {"torus", 1, 0}, {"cube", 1, 2},
      {"two_spheres", 2, 4}, {"knot", 1, 0},  {"open_sphere", 1, 1}};
  for (const auto& [name, components, euler] : expected) {
    const auto mesh = std::get<TriangleMesh>(make_sample(name));
    const SurfaceChains chains = surface_chains(mesh.triangles);
    EXPECT_EQ(chains.components, components) << name;
    EXPECT_EQ(chains.euler(mesh.triangles.size()), euler) << name;
    EXPECT_EQ(chains.points, mesh.points.size()) << name;
    EXPECT_EQ(chains.surplus_fans, 0u) << name;
  }
}

TEST(SurfaceChains, FansThatTouchInAPoint) {
  const std::vector<Triangle> bow_tie{{0, 1, 2}, {0, 3, 4}};
  const SurfaceChains chains = surface_chains(bow_tie);
  EXPECT_EQ(chains.components, 2u);
  EXPECT_EQ(chains.points, 5u);
  EXPECT_EQ(chains.surplus_fans, 1u);
  EXPECT_EQ(chains.touching_points, std::vector<Index>{0});
}

TEST(SurfaceChains, EdgesCountTheirTriangles) {
  const std::vector<Triangle> book{{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
  const SurfaceChains chains = surface_chains(book);
  EXPECT_EQ(chains.edges.size(), 7u);
  EXPECT_EQ(chains.edges[0].ids, (std::array<Index, 2>{0, 1}));
  EXPECT_EQ(chains.edges[0].count, 3u);
  EXPECT_EQ(surface_chains({}).components, 0u);
}

}  // namespace
}  // namespace tetwright::surface_chains_test

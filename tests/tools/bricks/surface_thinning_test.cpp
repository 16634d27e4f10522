// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/surface_thinning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "common/geometry/triangle_distance.h"
#include "tests/simplify/meshes.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::surface_thinning_test {
namespace {

/// Two materials in a box of n cells, of which a smooth surface is the interface.
TetMesh surface_of_waves(int n, double height) {
  TetMesh mesh =
      grid_mesh({n, n, n}, [&](int, int, int z) -> std::optional<MaterialTag> { return z < n / 2 ? 1 : 2; });
  mesh.interfaces = find_interfaces(mesh);
  for (Vec3& p : mesh.points)
    if (p.x() > 0 && p.x() < n && p.y() > 0 && p.y() < n && p.z() == n / 2)
      p.z() += height * std::sin(p.x() * 0.7) * std::cos(p.y() * 0.6);
  mesh.tets.clear();
  mesh.materials.clear();
  return mesh;
}

/// Euler characteristic of the faces between two materials.
std::ptrdiff_t euler(const TetMesh& mesh, const MaterialPair& pair) {
  std::set<Index> points;
  std::set<std::pair<Index, Index>> edges;
  std::ptrdiff_t faces = 0;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    if (t.pair() != pair) continue;
    ++faces;
    for (std::size_t k = 0; k < 3; ++k) {
      points.insert(t.ids[k]);
      edges.insert(std::minmax(t.ids[k], t.ids[(k + 1) % 3]));
    }
  }
  return static_cast<std::ptrdiff_t>(points.size()) - static_cast<std::ptrdiff_t>(edges.size()) + faces;
}

/// Largest distance of a point of `from` to the faces of `to` of the same kind as one of its own.
double distance(const TetMesh& from, const TetMesh& to) {
  std::map<MaterialPair, std::vector<TriangleDistance>> faces;
  for (const InterfaceTriangle& t : to.interfaces)
    faces[t.pair()].emplace_back(to.points[t.ids[0]], to.points[t.ids[1]], to.points[t.ids[2]]);
  double largest = 0;
  for (const InterfaceTriangle& t : from.interfaces)
    for (const Index p : t.ids) {
      double best = 1e300;
      for (const TriangleDistance& d : faces.at(t.pair()))
        best = std::min(best, d.squared(from.points[p], best));
      largest = std::max(largest, std::sqrt(best));
    }
  return largest;
}

TEST(ThinSurface, StaysWithinTheDistanceAndKeepsTheTopology) {
  constexpr double max_distance = 0.02;
  const TetMesh whole = surface_of_waves(10, 0.4);
  TetMesh thin = whole;
  std::vector<std::uint8_t> kept(whole.points.size(), 0);
  std::vector<InterfaceTriangle> none;
  thin_surface(thin, kept, max_distance, none);
  EXPECT_LT(thin.interfaces.size(), whole.interfaces.size() * 2 / 3);
  EXPECT_EQ(kept.size(), thin.points.size());
  EXPECT_LE(distance(whole, thin), max_distance * (1 + 1e-9));
  EXPECT_GT(distance(whole, thin), 0.1 * max_distance);  // it has used the bound
  const auto groups = interface_groups(whole.interfaces);
  EXPECT_EQ(interface_groups(thin.interfaces), groups);
  for (const MaterialPair& pair : groups) EXPECT_EQ(euler(thin, pair), euler(whole, pair)) << pair_name(pair);
  const MeshStatistics before = mesh_statistics(whole), after = mesh_statistics(thin);
  EXPECT_EQ(after.junction_edges, before.junction_edges);
  for (const auto& [pair, known] : before.interfaces)
    EXPECT_NEAR(after.interfaces.at(pair).area, known.area, 0.005 * known.area) << pair_name(pair);
}

TEST(ThinSurface, APlaneKeepsItsRimAndWhatIsShared) {
  const TetMesh whole = surface_of_waves(8, 0);
  TetMesh thin = whole;
  std::vector<std::uint8_t> kept;
  std::set<std::array<double, 3>> wanted;
  for (const Vec3& p : whole.points) {
    kept.push_back(p.z() == 4 && std::fabs(p.x() - 3) <= 1);
    if (kept.back()) wanted.insert({p.x(), p.y(), p.z()});
  }
  // A face beside the surface keeps its points, which get new numbers.
  std::vector<InterfaceTriangle> beside;
  for (const InterfaceTriangle& t : whole.interfaces)
    if (std::all_of(t.ids.begin(), t.ids.end(), [&](Index p) { return kept[p] != 0; })) beside.push_back(t);
  ASSERT_FALSE(beside.empty());
  std::vector<InterfaceTriangle> left = beside;
  thin_surface(thin, kept, 1e-6, left);
  EXPECT_LT(thin.interfaces.size(), whole.interfaces.size() / 2);
  EXPECT_LE(distance(whole, thin), 1e-6);
  for (std::size_t p = 0; p < thin.points.size(); ++p)
    if (kept[p]) wanted.erase({thin.points[p].x(), thin.points[p].y(), thin.points[p].z()});
  EXPECT_TRUE(wanted.empty());
  for (std::size_t i = 0; i < beside.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(thin.points[left[i].ids[k]], whole.points[beside[i].ids[k]]);
}

TEST(ThinSurface, ATetrahedronAndNothingStay) {
  TetMesh mesh;
  std::vector<std::uint8_t> kept;
  std::vector<InterfaceTriangle> none;
  thin_surface(mesh, kept, 1, none);
  EXPECT_TRUE(mesh.interfaces.empty());
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.interfaces = {{{0, 2, 1}, 1, {}}, {{0, 1, 3}, 1, {}}, {{0, 3, 2}, 1, {}}, {{1, 2, 3}, 1, {}}};
  kept.assign(4, 0);
  thin_surface(mesh, kept, 10, none);
  EXPECT_EQ(mesh.interfaces.size(), 4u);
}

}  // namespace
}  // namespace tetwright::surface_thinning_test

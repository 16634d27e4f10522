// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/point_merging.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "common/geometry/predicates.h"
#include "tests/simplify/meshes.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"
#include "tetwright/sheets.h"
#include "tetwright/simplify.h"

namespace tetwright::point_merging_test {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
/// Nothing but topology and positive tets limits the moves.
constexpr PointMerging lax{.max_distance = unbounded,
                           .max_deviation = unbounded,
                           .min_smooth_cosine = 0,
                           .min_turn_cosine = -1,
                           .min_face_shape = 0};

/// Merges points of a mesh, and checks it if that changes anything.
std::optional<TetMesh> merged(const TetMesh& mesh, const PointMerging& options) {
  EditableMesh editable(TetMesh(mesh), "test");
  PointMerging working = options;
  working.max_distance *= editable.space().scale();
  working.max_deviation *= editable.space().scale();
  if (!merge_points(editable, working)) return std::nullopt;
  EXPECT_TRUE(editable.links_consistent());
  EXPECT_TRUE(editable.all_positive());
  TetMesh after = std::move(editable).to_mesh();
  for (const MeshFinding& f : check_mesh(after))
    if (kind_of(f.code).severity == Severity::error) ADD_FAILURE() << mesh_finding_line(f);
  for (const std::string& d : topology_differences(topology(mesh), topology(after))) ADD_FAILURE() << d;
  return after;
}

/// Merges points with several seeds: at least half of the tets must vanish, and nothing else.
void expect_kept(const TetMesh& mesh, PointMerging options, std::uint64_t seeds) {
  for (options.seed = 1; options.seed <= seeds; ++options.seed) {
    const std::optional<TetMesh> after = merged(mesh, options);
    ASSERT_TRUE(after);
    EXPECT_LT(2 * after->tets.size(), mesh.tets.size());
  }
}

std::map<MaterialTag, double> volumes(const TetMesh& mesh) {
  std::map<MaterialTag, double> sums;
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    const Tet& t = mesh.tets[i];
    sums[mesh.materials[i]] +=
        orient3d_value(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) / 6;
  }
  return sums;
}

/// Two materials side by side with a cavity of 2^3 cubes, and a sheet of 4 x 4 squares in one of them. Their
/// interface has two patches. Positions of inner points are random.
TetMesh two_materials() {
  constexpr int n = 12;
  TetMesh mesh = grid_mesh({2 * n, n, n}, [](int x, int y, int z) -> std::optional<MaterialTag> {
    const auto hollow = [](int i) { return i == 5 || i == 6; };
    if (hollow(x) && hollow(y) && hollow(z)) return std::nullopt;
    return x < n ? -3 : 8;
  });
  mesh.interfaces = find_interfaces(mesh);
  for (InterfaceTriangle& t : mesh.interfaces)
    if (t.pair() == MaterialPair(-3, 8) &&
        std::all_of(t.ids.begin(), t.ids.end(), [&](Index p) { return mesh.points[p].y() <= 5; }))
      t.patch = 7;
  const auto on_sheet = [&](Index p) {
    const Vec3& at = mesh.points[p];
    return at.z() == 6 && at.x() >= n + 4 && at.x() <= n + 8 && at.y() >= 4 && at.y() <= 8;
  };
  std::vector<InterfaceTriangle> sheet;
  for (const MeshFace& f : mesh_faces(mesh.tets, mesh.points.size()))
    if (f.count == 2 && std::all_of(f.ids.begin(), f.ids.end(), on_sheet)) sheet.push_back({f.ids, 8, 8, 1});
  append_sheets(mesh.interfaces, sheet);
  std::vector<std::uint8_t> on_surface(mesh.points.size(), 0);
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids) on_surface[p] = 1;
  Random random(5);
  for (std::size_t p = 0; p < mesh.points.size(); ++p)
    for (int a = 0; a < 3; ++a)
      if (const double by = 0.2 * (random.uniform() - 0.5); !on_surface[p]) mesh.points[p][a] += by;
  return mesh;
}

/// The area of the interface between two materials, by patch.
std::map<std::uint16_t, double> patch_areas(const TetMesh& mesh, const MaterialPair& pair) {
  std::map<std::uint16_t, double> areas;
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (t.pair() == pair)
      areas[t.patch] += (mesh.points[t.ids[1]] - mesh.points[t.ids[0]])
                            .cross(mesh.points[t.ids[2]] - mesh.points[t.ids[0]])
                            .norm() /
                        2;
  return areas;
}

/// A ring of `around` segments with a square cross-section of `across` cubes, bent to a torus whose tube has
/// a round cross-section.
TetMesh torus(int around, int across) {
  TetMesh mesh = grid_mesh({around, across, across}, [](int, int, int) { return 1; });
  // Join both ends: a point at the far end becomes the one at the near end.
  std::vector<Index> joined(mesh.points.size());
  for (Index p = 0; p < joined.size(); ++p) {
    joined[p] = p;
    for (Index q = 0; q < joined.size(); ++q)
      if (mesh.points[p] == mesh.points[q] + Vec3(around, 0, 0)) joined[p] = q;
  }
  for (Tet& t : mesh.tets)
    for (Index& p : t) p = joined[p];
  const double half = across / 2.0;
  for (Vec3& at : mesh.points) {
    const double u = at.y() - half, v = at.z() - half;
    const double square = std::max(std::fabs(u), std::fabs(v)), round = std::hypot(u, v);
    const double scale = round > 0 ? square / round : 0;
    const double angle = -2 * 3.141592653589793 * at.x() / around;
    const double radius = 3 * half + scale * u;
    at = {radius * std::cos(angle), radius * std::sin(angle), scale * v};
  }
  const double total = volumes(mesh).at(1);
  if (total < 0)
    for (Tet& t : mesh.tets) std::swap(t[0], t[1]);
  return mesh;
}

TEST(PointMerging, KeepsFlatSurfacesPatchesAndSheets) {
  const TetMesh before = two_materials();
  ASSERT_FALSE(sheets_of(before).empty());
  const std::optional<TetMesh> after =
      merged(before, {.max_distance = unbounded, .max_deviation = unbounded});
  ASSERT_TRUE(after);
  EXPECT_LT(2 * after->tets.size(), before.tets.size());
  EXPECT_LT(4 * after->interfaces.size(), 3 * before.interfaces.size());
  EXPECT_EQ(sheets_of(*after).size(), sheets_of(before).size());
  const std::map<MaterialTag, double> was = volumes(before), is = volumes(*after);
  ASSERT_EQ(is.size(), 2);
  for (const auto& [tag, volume] : was) EXPECT_NEAR(is.at(tag), volume, 1e-12 * volume);
  const auto areas = patch_areas(before, {-3, 8}), new_areas = patch_areas(*after, {-3, 8});
  ASSERT_EQ(new_areas.size(), 2);
  for (const auto& [patch, area] : areas) EXPECT_NEAR(new_areas.at(patch), area, 1e-9 * area);
}

TEST(PointMerging, KeepsHandlesOfFewEdges) {
  // An arch and a tunnel of one and two cubes in a block, whose volume hardly changes if they vanish.
  constexpr int n = 12;
  for (const int thick : {1, 2}) {
    const auto within = [&](int i, int from) { return i >= from && i < from + thick; };
    const TetMesh mesh =
        grid_mesh({n, n, n + 3 + thick}, [&](int x, int y, int z) -> std::optional<MaterialTag> {
          if (z < n) {
            if (within(x, 8) && within(z, 4)) return std::nullopt;  // the tunnel
            return 1;
          }
          const bool leg = within(x, 2) || within(x, 7), top = z >= n + 3 && x >= 2 && x < 7 + thick;
          if (within(y, 5) && (leg || top)) return 1;
          return std::nullopt;
        });
    expect_kept(mesh, lax, 30);
  }
}

TEST(PointMerging, KeepsSmallBodiesAndCavities) {
  constexpr int n = 24;
  const TetMesh mesh = grid_mesh({n, n, n + 4}, [](int x, int y, int z) -> std::optional<MaterialTag> {
    const auto pair_in = [](int i, int period) { return i % period == 3 || i % period == 4; };
    const bool small = pair_in(x, 8) && pair_in(y, 8);
    if (z < n) {
      if (small && (z == 10 || z == 11)) return std::nullopt;  // nine cavities of 2^3 cubes
      return 1;
    }
    if (small && z >= n + 2) return 1;  // nine bodies
    return std::nullopt;
  });
  expect_kept(mesh, lax, 10);
}

/// Adds a ball of 23 points: two poles, two rings of ten, the centre.
void add_drum(TetMesh& mesh, const Vec3& at, double radius) {
  constexpr Index ring = 10;
  const auto base = static_cast<Index>(mesh.points.size());
  const auto add = [&](double x, double y, double z) { mesh.points.push_back(at + radius * Vec3(x, y, z)); };
  add(0, 0, 1);
  add(0, 0, -1);
  for (const double side : {1.0, -1.0})
    for (Index i = 0; i < ring; ++i) {
      const double angle = 2 * 3.141592653589793 * (i + (side < 0 ? 0.5 : 0)) / ring;
      add(0.9 * std::cos(angle), 0.9 * std::sin(angle), 0.42 * side);
    }
  add(0, 0, 0);
  const auto tet = [&](Index a, Index b, Index c) {
    mesh.tets.push_back({base + 2 + 2 * ring, base + a, base + b, base + c});
    mesh.materials.push_back(1);
  };
  for (Index i = 0; i < ring; ++i) {
    const Index u = 2 + i, v = 2 + (i + 1) % ring, x = u + ring, y = v + ring;
    tet(0, v, u);
    tet(1, x, y);
    tet(u, v, x);
    tet(v, y, x);
  }
}

TEST(PointMerging, KeepsSmallBalls) {
  // They may collapse onto an edge between two poles, with the ring of triangles between these.
  TetMesh mesh = grid_mesh(16);
  for (int i = 0; i < 300; ++i) add_drum(mesh, Vec3(i % 20, i / 20, 20), 0.2);
  for (Tet& t : mesh.tets)
    if (orient3d(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) < 0)
      std::swap(t[0], t[1]);
  expect_kept(mesh, {.max_distance = 2.3, .max_deviation = 0.15}, 10);
}

TEST(PointMerging, BoundsDeviationAndLengths) {
  const TetMesh before = torus(40, 8);
  constexpr double deviation = 0.1, distance = 2;
  const std::optional<TetMesh> after =
      merged(before, {.max_distance = distance, .max_deviation = deviation, .min_smooth_cosine = 0.5});
  ASSERT_TRUE(after);
  EXPECT_LT(3 * after->tets.size(), 2 * before.tets.size());
  // Every face is near the plane of the surface around it: the torus, whose points are kept.
  double farthest = 0, longest_moved = 0;
  const TetMesh surface = *after;
  for (const InterfaceTriangle& t : find_interfaces(surface)) {
    Vec3 middle = Vec3::Zero();
    for (int k = 0; k < 3; ++k) middle += surface.points[t.ids[k]] / 3;
    const double ring = std::hypot(middle.x(), middle.y()) - 12, tube = std::hypot(ring, middle.z());
    farthest = std::max(farthest, std::fabs(tube - 4));
    for (int k = 0; k < 3; ++k)
      longest_moved =
          std::max(longest_moved, (surface.points[t.ids[k]] - surface.points[t.ids[(k + 1) % 3]]).norm());
  }
  EXPECT_LT(farthest, 4 * deviation);
  double longest_before = 0;
  for (const InterfaceTriangle& t : find_interfaces(before))
    for (int k = 0; k < 3; ++k)
      longest_before =
          std::max(longest_before, (before.points[t.ids[k]] - before.points[t.ids[(k + 1) % 3]]).norm());
  EXPECT_LE(longest_moved, std::max(distance, longest_before));
}

TEST(PointMerging, KeepsSurfacesApart) {
  // Two bodies whose wavy surfaces are much closer to each other than new faces are to the old ones.
  constexpr int n = 24, half = 4;
  TetMesh mesh = grid_mesh({n, n, 2 * half + 1}, [](int, int, int z) -> std::optional<MaterialTag> {
    if (z == half) return std::nullopt;
    return 1;
  });
  for (Vec3& at : mesh.points) {
    const double wave = 0.6 * std::sin(at.x()) * std::sin(at.y());
    if (at.z() > half)
      at.z() += wave * (2 * half + 1 - at.z()) / half - 0.99;
    else
      at.z() += wave * at.z() / half;
  }
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    PointMerging options = lax;
    options.seed = seed;
    const std::optional<TetMesh> after = merged(mesh, options);
    ASSERT_TRUE(after);
    EXPECT_LT(after->tets.size(), mesh.tets.size());
  }
}

TEST(PointMerging, KeepsVolumes) {
  // A small region within a large one: its volume must be kept, too.
  TetMesh mesh = torus(24, 12);
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    Vec3 middle = Vec3::Zero();
    for (const Index p : mesh.tets[i]) middle += mesh.points[p] / 4;
    const double ring = std::hypot(middle.x(), middle.y()) - 18;
    mesh.materials[i] = ring * ring + middle.z() * middle.z() < 9 && middle.x() > 0 ? 2 : 1;
  }
  const std::optional<TetMesh> after = merged(mesh, lax);
  ASSERT_TRUE(after);
  EXPECT_LT(after->tets.size(), mesh.tets.size());
  const std::map<MaterialTag, double> was = volumes(mesh), is = volumes(*after);
  for (const auto& [tag, volume] : was)
    EXPECT_NEAR(is.at(tag), volume, MergingTuning::max_volume_change * volume);
}

TEST(PointMerging, IsTheSameForAnyNumberOfThreads) {
  // Enough tets for several parts of each loop.
  const TetMesh mesh = grid_mesh(24);
  std::optional<TetMesh> one, three;
  PointMerging options = lax;
  options.seed = 7;
  with_threads(1, [&] { one = merged(mesh, options); });
  with_threads(3, [&] { three = merged(mesh, options); });
  ASSERT_TRUE(one && three);
  EXPECT_LT(3 * one->tets.size(), mesh.tets.size());
  EXPECT_EQ(one->tets, three->tets);
  EXPECT_EQ(one->points, three->points);
}

TEST(PointMerging, MovesNoPointFartherThanAllowed) {
  const TetMesh mesh = grid_mesh(6);
  PointMerging options = lax;
  options.max_distance = 0.9;
  EXPECT_EQ(merged(mesh, options)->tets.size(), mesh.tets.size());
  options.max_distance = 1.1;
  EXPECT_LT(merged(mesh, options)->tets.size(), mesh.tets.size());
}

TEST(PointMerging, LeavesMeshesWithNegativeTetsAlone) {
  TetMesh mesh = grid_mesh(6);
  std::swap(mesh.points[100], mesh.points[101]);
  EXPECT_FALSE(merged(mesh, lax));
}

TEST(PointMerging, LeavesFrozenPointsAlone) {
  const TetMesh mesh = grid_mesh(8);
  EditableMesh editable{TetMesh(mesh), "test"};
  editable.freeze(std::vector<std::uint8_t>(mesh.points.size(), 1));
  ASSERT_TRUE(merge_points(editable, lax));
  EXPECT_EQ(editable.live_tets(), mesh.tets.size());
}

TEST(PointMerging, EndsWithTheDeadlineAndChangesNothing) {
  const TetMesh mesh = grid_mesh(8);
  EditableMesh editable{TetMesh(mesh), "test"};
  Progress progress;
  progress.set_deadline(Progress::Clock::now());
  EXPECT_THROW(merge_points(editable, lax, &progress), OutOfTime);
  EXPECT_EQ(editable.live_tets(), mesh.tets.size());
  EXPECT_TRUE(editable.links_consistent());
  progress.set_deadline(Progress::no_deadline);
  ASSERT_TRUE(merge_points(editable, lax, &progress));
  EXPECT_LT(editable.live_tets(), mesh.tets.size());
}

TEST(PointMerging, IsNotUsedWhereSurfacesIntersect) {
  SimplifyOptions options;
  options.target_tets = 2000;
  options.max_iterations = 1;
  const TetMesh body = grid_mesh(20);
  SimplifyReport report;
  simplify(body, options, &report);
  EXPECT_LT(report.iterations.front().tets_before, body.tets.size());
  // Two of these, one inside the other in part. All tets are positive.
  TetMesh mesh = body;
  for (const Vec3& p : body.points) mesh.points.push_back(p + Vec3(10.5, 0.25, 0.25));
  for (Tet t : body.tets) {
    for (Index& p : t) p += static_cast<Index>(body.points.size());
    mesh.tets.push_back(t);
    mesh.materials.push_back(1);
  }
  report = {};
  simplify(mesh, options, &report);
  EXPECT_EQ(report.iterations.front().tets_before, mesh.tets.size());
}

}  // namespace
}  // namespace tetwright::point_merging_test

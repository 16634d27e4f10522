// SPDX-License-Identifier: Apache-2.0
#include "tetwright/simplify.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "tests/simplify/meshes.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/remesher.h"
#include "tetwright/resources.h"

namespace tetwright::simplify_test {
namespace {

using Tag = std::optional<MaterialTag>;

bool same_bytes(const TetMesh& a, const TetMesh& b) {
  return a.points.size() == b.points.size() && a.tets == b.tets && a.materials == b.materials &&
         std::memcmp(a.points.data(), b.points.data(), a.points.size() * sizeof(Vec3)) == 0;
}

/// A ring of two materials, one with a cavity, 18 cubes wide: a handle, a cavity, an interface, junctions.
TetMesh ring() {
  TetMesh mesh = grid_mesh({18, 18, 6}, [](int x, int y, int z) -> Tag {
    if (x >= 6 && x < 12 && y >= 6 && y < 12) return {};
    if (x >= 2 && x < 4 && y >= 8 && y < 10 && z >= 2 && z < 4) return {};
    return x < 9 ? 4 : 7;
  });
  jitter(mesh, 17);
  return mesh;
}

void expect_guarantees(const TetMesh& before, const TetMesh& after, std::size_t target) {
  for (const MeshFinding& finding : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(finding);
  for (const std::string& d : topology_differences(topology(before), topology(after))) ADD_FAILURE() << d;
  EXPECT_NEAR(static_cast<double>(after.tets.size()), static_cast<double>(target),
              0.01 * static_cast<double>(target));
}

TEST(Simplify, ReachesTheCountAndKeepsTheTopology) {
  const TetMesh mesh = ring();
  SimplifyOptions options;
  options.target_tets = 1500;
  SimplifyReport report;
  const TetMesh after = simplify(mesh, options, &report);
  expect_guarantees(mesh, after, 1500);
  EXPECT_EQ(after.interfaces, find_interfaces(after));
  EXPECT_EQ(interface_groups(after.interfaces),
            (std::vector<MaterialPair>{{4, std::nullopt}, {4, 7}, {7, std::nullopt}}));
  EXPECT_FALSE(report.iterations.empty());
  EXPECT_EQ(report.iterations.back().tets_after, after.tets.size());
}

// A caller's mesh is not one that a reader has checked.
TEST(Simplify, ArraysThatDoNotFitTogetherAreRefused) {
  struct Case {
    const char* what;
    std::function<void(TetMesh&)> damage;
    const char* message;
  };
  const std::vector<Case> cases{
      {"no materials", [](TetMesh& m) { m.materials.clear(); }, "but 0 materials; give one for each tet"},
      {"an index out of range", [](TetMesh& m) { m.tets[7][2] = 1u << 30; },
       "tet 7 refers to point 1073741824"},
      {"a field of points",
       [](TetMesh& m) {
         m.point_fields = {{.name = "heat", .values = {1, 2}}};
       },
       "the field 'heat' has 2 values"},
      {"a field of tets",
       [](TetMesh& m) { m.cell_fields = {{.name = "load", .components = 0, .values = {}}}; },
       "the field 'load' has 0 values"},
      {"an interface",
       [](TetMesh& m) {
         m.interfaces = {{{0, 1, 1u << 30}, 1, {}}};
       },
       "an interface triangle refers to a point that does not exist"}};
  for (const Case& c : cases) {
    TetMesh mesh = grid_mesh(3);
    c.damage(mesh);
    const auto expect = [&](const char* by, const std::function<void()>& work) {
      try {
        work();
        ADD_FAILURE() << by << ": " << c.what << " was not refused";
      } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find(c.message), std::string::npos) << by << ": " << e.what();
      }
    };
    expect("simplify", [&] { (void)simplify(mesh, {.target_tets = 10}); });
    expect("improve", [&] { (void)improve(mesh, {}); });
    expect("Remesher", [&] { Remesher remesher(mesh, RemesherOptions{}); });
  }
  EXPECT_THROW((void)simplify(grid_mesh(3), {.target_tets = 10, .frozen = {1}}), UsageError);
}

// An operation that never succeeds in the optimised build would be silently broken. Insertions in tets and
// faces are the last resort, which these meshes do not need; insertion_test.cpp tests them.
TEST(Simplify, EveryOperationSucceedsAtLeastOnce) {
  OperationCounts counts;
  for (Schedule schedule : {Schedule::tuned, Schedule::paper}) {
    SimplifyOptions options;
    options.target_tets = 1500;
    options.schedule = schedule;
    SimplifyReport report;
    simplify(ring(), options, &report);
    for (const auto& it : report.iterations) counts.add(it.counts);
  }
  TetMesh crooked = grid_mesh({8, 8, 8}, [](int x, int y, int) -> Tag { return x < 4 ? 1 : y < 4 ? 2 : 3; });
  jitter(crooked, 2, 0.9);
  SimplifyReport report;
  improve(crooked, ImproveOptions(), &report);
  for (const auto& it : report.iterations) counts.add(it.counts);
  for (std::size_t o = 0; o < operation_count; ++o) {
    const auto operation = static_cast<Operation>(o);
    if (operation == Operation::insert_in_tet || operation == Operation::insert_in_face) continue;
    EXPECT_GT(counts.of(operation, Outcome::done), 0u) << operation_names[o];
  }
}

TEST(Simplify, OneThreadAndOneSeedGiveTheSameBytes) {
  const ThreadLimit one(1);
  SimplifyOptions options;
  options.target_tets = 1200;
  const TetMesh first = simplify(ring(), options);
  EXPECT_TRUE(same_bytes(first, simplify(ring(), options)));
  options.seed = 2;
  EXPECT_FALSE(same_bytes(first, simplify(ring(), options)));
}

TEST(Simplify, AnyNumberOfThreadsGivesTheSameGuarantees) {
  const TetMesh mesh = ring();
  SimplifyOptions options;
  options.target_tets = 1500;
  options.batch_size = 50;
  for (unsigned threads : {2u, 5u}) {
    const ThreadLimit limit(threads);
    expect_guarantees(mesh, simplify(mesh, options), 1500);
  }
}

TEST(Simplify, SizeAndPlaceDoNotMatter) {
  TetMesh mesh = grid_mesh(10);
  Random random(3);
  for (Vec3& p : mesh.points)  // multiples of 1/64, so that moves far away are exact
    p += Vec3(random.below(9), random.below(9), random.below(9)) / 64;
  SimplifyOptions options;
  options.target_tets = 600;
  const ThreadLimit one(1);
  const TetMesh plain = simplify(mesh, options);
  for (double factor : {0x1p-700, 0x1p300}) {
    TetMesh scaled = mesh;
    for (Vec3& p : scaled.points) p *= factor;  // exact: the same connectivity
    const TetMesh after = simplify(scaled, options);
    EXPECT_EQ(after.tets, plain.tets);
    for (std::size_t i = 0; i < plain.points.size(); ++i)
      EXPECT_EQ(after.points[i], plain.points[i] * factor);
  }
  for (const Vec3& by : {Vec3(1 << 20, 0, 0), Vec3(-7.5, 0x1p15, 0x1p22)}) {
    TetMesh moved = mesh;
    for (Vec3& p : moved.points) p += by;  // exact too
    const TetMesh after = simplify(moved, options);
    EXPECT_EQ(after.tets, plain.tets);
    for (std::size_t i = 0; i < plain.points.size(); ++i) EXPECT_EQ(after.points[i], plain.points[i] + by);
  }
}

// Output coordinates are representable as doubles, and signs hold for them.
TEST(Simplify, FarFromTheOriginTheWrittenMeshIsValid) {
  TetMesh mesh = grid_mesh(10);
  jitter(mesh, 9);
  const double diagonal = 10 * std::sqrt(3.0);
  for (Vec3& p : mesh.points) p += Vec3::Constant(1e6 * diagonal);
  ASSERT_TRUE(check_mesh(mesh).empty());
  const Topology before = topology(mesh);
  SimplifyOptions options;
  options.target_tets = 600;
  const TetMesh after = simplify(mesh, options);
  for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
  for (const std::string& d : topology_differences(before, topology(after))) ADD_FAILURE() << d;
  EXPECT_NEAR(static_cast<double>(after.tets.size()), 600, 6);
}

TEST(Simplify, AMeshBelowTheTargetIsOnlyImproved) {
  TetMesh mesh = grid_mesh(6);
  jitter(mesh, 8, 0.4);
  SimplifyOptions options;
  options.target_tets = mesh.tets.size();
  const TetMesh after = simplify(mesh, options);
  expect_guarantees(mesh, after, mesh.tets.size());
}

TEST(Simplify, UnreachableTargetsEndWithTheSmallestMesh) {
  SimplifyOptions options;
  options.target_tets = 1;
  const TetMesh mesh = ring();
  const TetMesh after = simplify(mesh, options);
  for (const MeshFinding& finding : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(finding);
  for (const std::string& d : topology_differences(topology(mesh), topology(after))) ADD_FAILURE() << d;
  EXPECT_LT(after.tets.size(), mesh.tets.size() / 5);
}

TEST(Simplify, WithoutAnyTimeTheMeshIsAsItCame) {
  const TetMesh mesh = ring();
  Progress progress;
  progress.set_deadline(Progress::Clock::now());
  SimplifyOptions options;
  options.target_tets = 1500;
  options.tolerance = 0.1;
  for (const auto& work :
       {std::function([&](SimplifyReport* report) { return simplify(mesh, options, report, &progress); }),
        std::function([&](SimplifyReport* report) { return improve(mesh, {}, report, &progress); })}) {
    SimplifyReport report;
    const TetMesh after = work(&report);
    EXPECT_TRUE(same_bytes(after, mesh));
    EXPECT_EQ(after.interfaces, find_interfaces(mesh));
    EXPECT_TRUE(report.out_of_time);
    EXPECT_TRUE(report.iterations.empty());
  }
  // The distance of the result is reported nevertheless.
  SimplifyReport report;
  (void)simplify(mesh, options, &report, &progress);
  ASSERT_TRUE(report.deviation);
  EXPECT_EQ(report.deviation->upper(), 0);
  TriangleMesh moved{mesh.points, {}, {}, {}};
  for (Vec3& p : moved.points) p.x() += 0.05;
  for (const InterfaceTriangle& t : find_interfaces(mesh)) moved.triangles.push_back(t.ids);
  options.surface = &moved;
  (void)simplify(mesh, options, &report, &progress);
  ASSERT_TRUE(report.deviation);
  EXPECT_LE(report.deviation->from_mesh.lower, 0.0501);
  EXPECT_GE(report.deviation->upper(), 0.0499);
}

TEST(Simplify, ADeadlineAtAnyMomentLeavesAValidMesh) {
  const TetMesh mesh = ring();
  SimplifyOptions options;
  options.target_tets = 1500;
  options.tolerance = 0.1;

  // Deadlines at several times within the duration of the work, which varies, and some later ones.
  SimplifyReport whole;
  SimplifyOptions without_tolerance = options;
  without_tolerance.tolerance = 0;
  (void)simplify(mesh, without_tolerance, &whole);
  int before_any_change = 0;
  for (const double share : {0.1, 0.4, 0.7, 1.0, 3.0, 8.0}) {
    Progress progress;
    progress.set_deadline(Progress::Clock::now() +
                          std::chrono::duration_cast<Progress::Clock::duration>(
                              std::chrono::duration<double>(share * whole.seconds_build)));
    SimplifyReport report;
    const TetMesh after = simplify(mesh, options, &report, &progress);
    for (const MeshFinding& finding : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(finding);
    for (const std::string& d : topology_differences(topology(mesh), topology(after))) ADD_FAILURE() << d;
    ASSERT_TRUE(report.deviation);
    // The tolerance holds, whether proven or not.
    EXPECT_LE(report.deviation->from_mesh.lower, options.tolerance);
    EXPECT_LE(report.deviation->from_surface.lower, options.tolerance);
    EXPECT_TRUE(report.out_of_time);
    before_any_change += report.iterations.empty();
  }
  EXPECT_GT(before_any_change, 0);
}

TEST(Simplify, CancelsAndRefuses) {
  Progress progress;
  progress.cancel();
  SimplifyOptions options;
  EXPECT_THROW(simplify(grid_mesh(4), options, nullptr, &progress), Interrupted);
  options.target_tets = 0;
  EXPECT_THROW(simplify(grid_mesh(4), options), UsageError);
  EXPECT_THROW(simplify(TetMesh(), SimplifyOptions()), InputError);
}

}  // namespace
}  // namespace tetwright::simplify_test

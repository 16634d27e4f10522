// SPDX-License-Identifier: Apache-2.0
#include "tetwright/remesher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/geometry/box_tree.h"
#include "common/geometry/predicates.h"
#include "simplify/remesh/tet_overlap.h"
#include "tests/simplify/meshes.h"
#include "tests/simplify/patches.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/progress.h"
#include "tetwright/resources.h"
#include "tetwright/simplify.h"

namespace tetwright::remesher_test {
namespace {

using Tag = std::optional<MaterialTag>;

TetMesh two_halves(int n, std::uint64_t seed, double amount = 0.3) {
  TetMesh mesh = grid_mesh({n, n, n}, [n](int x, int, int) { return Tag(2 * x < n ? 1 : 2); });
  jitter(mesh, seed, amount);
  return mesh;
}

void expect_sound(const TetMesh& before, const Remesher& remesher) {
  const TetMesh after = remesher.mesh();
  for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
  for (const std::string& d : topology_differences(topology(before), topology(after))) ADD_FAILURE() << d;
}

float worst_quality(const Remesher& r) {
  float worst = 1;
  for (Index t = 0; t < r.tet_slots(); ++t)
    if (r.has_tet(t)) worst = std::min(worst, r.quality(t));
  return worst;
}

double volume_of(const Remesher& r, Index t) {
  const Tet& p = r.tet(t);
  return orient3d_value(r.position(p[0]), r.position(p[1]), r.position(p[2]), r.position(p[3])) / 6;
}

/// Sum over a material's tets of a field's value times volume, and the sum of its magnitude.
std::pair<double, double> integral(Remesher& r, std::size_t field, MaterialTag material) {
  long double sum = 0, size = 0;
  for (Index t = 0; t < r.tet_slots(); ++t)
    if (r.has_tet(t) && r.material(t) == material) {
      const double part = r.tet_field(field)[t] * volume_of(r, t);
      sum += part;
      size += std::fabs(part);
    }
  return {static_cast<double>(sum), static_cast<double>(size)};
}

/// The state of a mesh by number.
struct Snapshot {
  explicit Snapshot(const Remesher& r) {
    for (Index t = 0; t < r.tet_slots(); ++t) tets.push_back(r.has_tet(t) ? r.tet(t) : Tet{});
    for (Index p = 0; p < r.point_slots(); ++p) {
      there.push_back(r.has_point(p));
      points.push_back(r.has_point(p) ? r.position(p) : Vec3::Zero());
    }
  }
  std::vector<Tet> tets;
  std::vector<bool> there;
  std::vector<Vec3> points;
};

/// Expects the lists to match the differences exactly.
void expect_told(const Snapshot& before, const Remesher& r, const RemeshChanges& c) {
  const std::set<Index> removed(c.removed_tets.begin(), c.removed_tets.end()),
      added(c.added_tets.begin(), c.added_tets.end());
  for (Index t = 0; t < r.tet_slots(); ++t) {
    const Tet was = t < before.tets.size() ? before.tets[t] : Tet{}, is = r.has_tet(t) ? r.tet(t) : Tet{};
    if (was == is) continue;
    EXPECT_EQ(removed.count(t), was != Tet{} ? 1u : 0u) << t;
    EXPECT_EQ(added.count(t), is != Tet{} ? 1u : 0u) << t;
  }
  for (Index t : c.added_tets) EXPECT_TRUE(r.has_tet(t));
  std::size_t moved = 0, gone = 0, came = 0;
  for (Index p = 0; p < r.point_slots(); ++p) {
    const bool was = p < before.there.size() && before.there[p], is = r.has_point(p);
    gone += was && !is;
    came += !was && is;
    moved += was && is && r.position(p) != before.points[p];
  }
  // A point's number may be reused in the same call: then it counts as moved.
  EXPECT_EQ(c.moved_points.size(), moved);
  EXPECT_EQ(c.removed_points.size(), gone);
  EXPECT_EQ(c.added_points.size(), came);
}

TEST(Remesher, ImprovesARegionAndNothingElse) {
  const TetMesh mesh = two_halves(10, 1, 0.48);
  Remesher r(mesh);
  const Snapshot before(r);
  const RemeshChanges c = r.improve(RemeshRegion::box({0, 0, 0}, {4, 4, 4}));
  EXPECT_GT(c.operations, 10u);
  expect_told(before, r, c);
  expect_sound(mesh, r);
  for (Index p = 0; p < before.points.size(); ++p)
    if (before.there[p] && before.points[p].maxCoeff() > 6.5) {
      EXPECT_EQ(r.position(p), before.points[p]);
    }
  EXPECT_GT(r.improve(RemeshRegion::where([](const Vec3&) { return true; })).operations, 10u);
  EXPECT_GT(worst_quality(r), shape_quality_bound(ShapeObjective::both, 0.1));
  expect_sound(mesh, r);
}

TEST(Remesher, ImprovesToAnAimWithinItsCountAndReports) {
  const TetMesh input = two_halves(8, 6, 0.45);
  SimplifyReport report;
  RemesherOptions options;
  options.report = &report;
  Remesher remesher(input, options);
  const auto below = [&](double angle) {
    std::vector<Index> tets;
    for (Index t = 0; t < remesher.tet_slots(); ++t)
      if (remesher.has_tet(t) && remesher.quality(t) <= shape_quality_bound(ShapeObjective::both, angle))
        tets.push_back(t);
    return tets;
  };
  const std::size_t bad = below(0.1).size();
  ASSERT_GT(bad, 50u);
  const std::size_t count = remesher.tet_count();
  const RemeshAim aim{.angle = 0.1,
                      .leave_surface_angle = 0.05,
                      .target_tets = count,
                      .min_tets = count - 10,
                      .max_tets = count + 10,
                      .max_rounds = 3};
  const RemeshChanges changes = remesher.improve(RemeshRegion::tets(below(0.1)), aim);
  EXPECT_LT(2 * below(0.1).size(), bad);
  EXPECT_GE(remesher.tet_count(), count - 10);
  EXPECT_LE(remesher.tet_count(), count + 10);
  EXPECT_GE(changes.rounds, 1);
  EXPECT_LE(changes.rounds, 3);
  EXPECT_EQ(report.iterations.size(), static_cast<std::size_t>(changes.rounds)) << changes.rounds;
  EXPECT_EQ(report.iterations.front().tets_before, count);
  EXPECT_EQ(report.iterations.back().tets_after, remesher.tet_count());
  // The bounds were for that call only.
  remesher.refine(RemeshRegion::box(Vec3(0, 0, 0), Vec3(3, 3, 3)), 0.4);
  EXPECT_GT(remesher.tet_count(), count + 10);
  expect_sound(input, remesher);

  EXPECT_THROW(remesher.improve(RemeshRegion::tets({}), {.angle = std::nan(""), .leave_surface_angle = 0.1}),
               UsageError);
  Progress progress;
  options.progress = &progress;
  Remesher cancelled(input, options);
  progress.cancel();
  EXPECT_THROW(cancelled.improve(RemeshRegion::box(Vec3(0, 0, 0), Vec3(8, 8, 8))), Interrupted);
}

TEST(Remesher, KeepsToTheFirstSurfacesOverManyCalls) {
  // A ball: a cube of tets whose shells are mapped to spheres.
  constexpr int n = 8;
  TetMesh ball = grid_mesh(n);
  for (Vec3& p : ball.points) {
    const Vec3 d = p - Vec3::Constant(n / 2);
    if (d.norm() > 0) p = d * (d.cwiseAbs().maxCoeff() / d.norm());
  }
  jitter(ball, 3, 0.2);
  ball.interfaces = find_interfaces(ball);
  // Max depth of the surface below the sphere, at its points or at its triangles' centroids.
  const auto depth = [](const TetMesh& mesh, bool middles) {
    double deepest = 0;
    for (const InterfaceTriangle& t : mesh.interfaces) {
      Vec3 middle = Vec3::Zero();
      for (const Index i : t.ids) {
        if (!middles) deepest = std::max(deepest, n / 2 - mesh.points[i].norm());
        middle += mesh.points[i] / 3;
      }
      if (middles) deepest = std::max(deepest, n / 2 - middle.norm());
    }
    return deepest;
  };
  double kept_depth = 0, drifted = 0;
  for (const bool keep : {true, false}) {
    RemesherOptions options;
    options.keep_surfaces = keep;
    Remesher remesher(ball, options);
    for (int call = 0; call < 12; ++call)
      remesher.improve(RemeshRegion::box(Vec3::Constant(-n), Vec3::Constant(n)),
                       {.angle = 0.5, .leave_surface_angle = 0, .max_rounds = 3});
    (keep ? kept_depth : drifted) = depth(remesher.mesh(), false);
  }
  EXPECT_LE(kept_depth, 1.01 * depth(ball, true));
  EXPECT_GT(drifted, kept_depth);
}

TEST(Remesher, CoarsensAndRefines) {
  const TetMesh mesh = two_halves(8, 2, 0.1);
  Remesher r(mesh);
  const RemeshRegion all = RemeshRegion::where([](const Vec3&) { return true; });
  Snapshot before(r);
  RemeshChanges c = r.coarsen(all, 2);
  expect_told(before, r, c);
  expect_sound(mesh, r);
  EXPECT_LT(r.tet_count(), mesh.tets.size() / 2);
  const std::size_t coarse = r.tet_count();
  before = Snapshot(r);
  c = r.refine(RemeshRegion::box({0, 0, 0}, {3, 3, 3}), 0.7);
  expect_told(before, r, c);
  expect_sound(mesh, r);
  EXPECT_GT(r.tet_count(), coarse);
  for (Index t = 0; t < r.tet_slots(); ++t) {
    if (!r.has_tet(t)) continue;
    bool inside = true;
    for (Index p : r.tet(t)) inside &= r.position(p).maxCoeff() < 1.5;
    if (!inside) continue;
    for (const auto& e : tet_edges)
      EXPECT_LT((r.position(r.tet(t)[e[0]]) - r.position(r.tet(t)[e[1]])).norm(), 0.7 * 4 / 3 * 1.5);
  }
  EXPECT_GT(worst_quality(r), 0);
}

TEST(Remesher, CoarseningEndsInARimOfGoodTetsAndNoPointBeyondItMoves) {
  const TetMesh mesh = two_halves(14, 5, 0.1);
  Remesher r(mesh);
  const Box3 box{{5, 5, 5}, {9, 9, 9}};
  // The points of the region's tets, and their neighbours.
  std::vector<bool> reach(r.point_slots(), false);
  for (Index p = 0; p < r.point_slots(); ++p) reach[p] = r.has_point(p) && box.contains(r.position(p));
  for (int ring = 0; ring < 2; ++ring) {
    const std::vector<bool> inside = reach;
    for (Index t = 0; t < r.tet_slots(); ++t)
      if (r.has_tet(t) && std::any_of(r.tet(t).begin(), r.tet(t).end(), [&](Index p) { return inside[p]; }))
        for (Index p : r.tet(t)) reach[p] = true;
  }
  const Snapshot before(r);
  const RemeshChanges c = r.coarsen(RemeshRegion::box(box.low, box.high), 2);
  expect_told(before, r, c);
  expect_sound(mesh, r);
  for (Index p = 0; p < before.points.size(); ++p)
    if (before.there[p] && !reach[p]) {
      EXPECT_TRUE(r.has_point(p));
      EXPECT_EQ(r.position(p), before.points[p]);
    }
  for (Index t = 0; t < before.tets.size(); ++t) {
    const Tet& was = before.tets[t];
    if (was != Tet{} && std::none_of(was.begin(), was.end(), [&](Index p) { return reach[p]; })) {
      EXPECT_EQ(r.tet(t), was);
    }
  }
  std::size_t bad = 0;
  for (Index t : c.added_tets) {
    const Tet& p = r.tet(t);
    bad += min_solid_angle(r.position(p[0]), r.position(p[1]), r.position(p[2]), r.position(p[3])) < 0.1;
  }
  EXPECT_GT(c.removed_tets.size(), c.added_tets.size() * 3 / 2);
  EXPECT_LT(bad, c.added_tets.size() / 50);  // a tenth if the rim is not improved
}

TEST(Remesher, CarriesLinearFieldsAndKeepsIntegrals) {
  const TetMesh mesh = two_halves(8, 3);
  Remesher r(mesh);
  const auto linear = [](const Vec3& p) { return 3 * p.x() - 2 * p.y() + 0.5 * p.z() + 7; };
  std::vector<double> at_points(r.point_slots(), 0), at_tets(2 * r.tet_slots(), 0);
  Random random(5);
  for (Index p = 0; p < r.point_slots(); ++p)
    if (r.has_point(p)) at_points[p] = linear(r.position(p));
  for (double& x : at_tets) x = random.uniform() - 0.3;
  r.add_point_field(1, at_points);
  std::vector<double> first(r.tet_slots());
  for (Index t = 0; t < r.tet_slots(); ++t) first[t] = at_tets[2 * t];
  r.add_tet_field(1, first);
  const RemeshRegion all = RemeshRegion::where([](const Vec3&) { return true; });
  const RemeshRegion corner = RemeshRegion::box({2, 2, 2}, {6, 6, 6});
  const auto check = [&] {
    // Inside the body interpolation is exact; the surface may move outwards slightly.
    for (Index p = 0; p < r.point_slots(); ++p)
      if (r.has_point(p)) {
        EXPECT_NEAR(r.point_field(0)[p], linear(r.position(p)), 0.5);
        const Vec3 x = r.position(p);
        if (x.minCoeff() > 1.2 && x.maxCoeff() < 6.8) {
          EXPECT_NEAR(r.point_field(0)[p], linear(x), 1e-9);
        }
      }
  };
  std::array<std::pair<double, double>, 2> before{integral(r, 0, 1), integral(r, 0, 2)};
  const auto expect_kept = [&] {
    for (int k = 0; k < 2; ++k) {
      const auto now = integral(r, 0, k + 1);
      EXPECT_NEAR(now.first, before[k].first, 1e-12 * before[k].second);
    }
  };
  r.improve(all);
  check();
  expect_kept();
  r.coarsen(corner, 1.6);
  check();
  expect_kept();
  r.refine(corner, 0.8);
  check();
  expect_kept();
}

TEST(Remesher, TakesPositionsOfAllOrSome) {
  const TetMesh mesh = two_halves(6, 4, 0.1);
  const auto bend = [](const Vec3& p) {
    return Vec3(p.x() + 0.2 * p.y() * p.y() / 6, p.y(), p.z() + 0.1 * p.x());
  };
  Remesher all(mesh), some(mesh);
  std::vector<Vec3> positions(all.point_slots(), Vec3::Zero());
  std::vector<Index> points;
  std::vector<Vec3> moved;
  for (Index p = 0; p < all.point_slots(); ++p)
    if (all.has_point(p)) {
      positions[p] = bend(all.position(p));
      points.push_back(p);
      moved.push_back(positions[p]);
    }
  all.set_positions(positions);
  some.set_positions(points, moved);
  const RemeshRegion whole = RemeshRegion::where([](const Vec3&) { return true; });
  for (Remesher* r : {&all, &some}) {
    for (Index p : points) EXPECT_LT((r->position(p) - positions[p]).norm(), 1e-14);
    r->improve(whole);
    expect_sound(mesh, *r);
  }
  EXPECT_EQ(all.mesh().tets, some.mesh().tets);
  EXPECT_THROW(all.set_positions(std::vector<Vec3>(3)), UsageError);
  positions[points[3]].x() = std::nan("");
  EXPECT_THROW(all.set_positions(positions), InputError);
  EXPECT_THROW(all.improve(RemeshRegion::tets({no_index})), UsageError);
}

TEST(Remesher, IsTheSameForAnyNumberOfThreads) {
  const TetMesh mesh = two_halves(8, 6, 0.45);
  std::vector<TetMesh> results;
  for (const unsigned threads : {1u, 2u, 8u}) {
    const ThreadLimit limit(threads);
    Remesher r(mesh);
    Random random(7);
    std::vector<double> at_points(3 * r.point_slots()), at_tets(r.tet_slots());
    for (double& x : at_points) x = random.uniform();
    for (double& x : at_tets) x = random.uniform();
    r.add_point_field(3, std::move(at_points));
    r.add_tet_field(1, std::move(at_tets));
    r.improve(RemeshRegion::box({0, 0, 0}, {5, 5, 5}));
    r.coarsen(RemeshRegion::box({4, 0, 0}, {8, 8, 8}), 1.5);
    r.refine(RemeshRegion::box({0, 0, 0}, {2, 2, 2}), 0.8);
    results.push_back(r.mesh());
  }
  for (const TetMesh& m : results) {
    EXPECT_EQ(m.tets, results[0].tets);
    EXPECT_EQ(m.points, results[0].points);
    ASSERT_EQ(m.point_fields.size(), 1u);
    ASSERT_EQ(m.cell_fields.size(), 1u);
    EXPECT_EQ(m.point_fields[0].values, results[0].point_fields[0].values);
    EXPECT_EQ(m.cell_fields[0].values, results[0].cell_fields[0].values);
  }
}

TEST(Remesher, ManyCallsLeaveTheMeshSoundAndSmall) {
  const TetMesh mesh = two_halves(6, 7, 0.2);
  Remesher r(mesh);
  Random random(8);
  std::size_t slots = 0;
  for (int call = 0; call < 120; ++call) {
    const Vec3 low(5 * random.uniform(), 5 * random.uniform(), 5 * random.uniform());
    const RemeshRegion box = RemeshRegion::box(low, low + Vec3::Constant(2));
    if (call % 3 == 0) r.coarsen(box, 1.6);
    if (call % 3 == 1) r.refine(box, 0.9);
    if (call % 3 == 2) r.improve(box);
    if (call == 60) slots = r.tet_slots();
  }
  expect_sound(mesh, r);
  EXPECT_EQ(r.tet_slots(), slots);
  const std::size_t count = r.tet_count();
  const Renumbering numbers = r.compact();
  EXPECT_EQ(r.tet_count(), count);
  EXPECT_GE(numbers.tets.size(), count);
  expect_sound(mesh, r);
}

TEST(Remesher, FrozenPointsStay) {
  const TetMesh mesh = two_halves(6, 9, 0.45);
  RemesherOptions options;
  options.fix_boundary = true;
  Renumbering numbers;
  Remesher r(mesh, options, &numbers);
  std::vector<std::pair<Index, Vec3>> fixed;
  for (const InterfaceTriangle& t : r.mesh().interfaces)
    for (Index p : t.ids) fixed.push_back({p, r.mesh().points[p]});
  const RemeshRegion all = RemeshRegion::where([](const Vec3&) { return true; });
  const auto interfaces = r.mesh().interfaces;
  r.improve(all);
  r.coarsen(all, 2);
  std::set<std::array<double, 3>> places;
  const TetMesh after = r.mesh();
  for (const Vec3& p : after.points) places.insert({p.x(), p.y(), p.z()});
  for (const auto& [id, p] : fixed) EXPECT_EQ(places.count({p.x(), p.y(), p.z()}), 1u);
  EXPECT_EQ(after.interfaces.size(), interfaces.size());
  expect_sound(mesh, r);
}

TEST(Remesher, KeepsPatchesWhenAllPositionsAreSetAfterOperations) {
  const TetMesh mesh = tetwright::two_halves(8, 3);
  Remesher r(mesh);
  const RemeshRegion all = RemeshRegion::where([](const Vec3&) { return true; });
  EXPECT_GT(r.refine(all, 0.9).operations, 10u);
  std::vector<Vec3> positions;
  for (Index p = 0; p < r.point_slots(); ++p)
    positions.push_back(r.has_point(p) ? r.position(p) : Vec3::Zero());
  r.set_positions(positions);
  r.improve(all);
  std::size_t inner = 0;
  const TetMesh after = r.mesh();
  for (const InterfaceTriangle& t : after.interfaces) {
    if (!t.other) continue;
    ++inner;
    const double y = (after.points[t.ids[0]] + after.points[t.ids[1]] + after.points[t.ids[2]]).y() / 3;
    EXPECT_EQ(t.patch, y < 4 ? 1 : 2);
  }
  EXPECT_GT(inner, 200u);
}

// Two cubes that touch along an edge. Its points exist twice and move together.
TEST(Remesher, MovesPointsThatWereSplit) {
  const TetMesh mesh = grid_mesh({2, 2, 2}, [](int x, int y, int) { return x == y ? Tag(1) : Tag(); });
  Remesher some(mesh), all(mesh);
  const Vec3 move(0.05, -0.02, 0.1);
  std::vector<Vec3> positions(all.point_slots(), Vec3::Zero());
  std::vector<Index> points;
  std::vector<Vec3> targets;
  for (Index p = 0; p < all.point_slots(); ++p) {
    if (!all.has_point(p)) continue;
    positions[p] = all.position(p);
    if (positions[p] != Vec3(1, 1, 1)) continue;
    positions[p] += move;
    points.push_back(p);
    targets.push_back(positions[p]);
  }
  ASSERT_EQ(points.size(), 2u);
  all.set_positions(positions);
  some.set_positions(points, targets);
  EXPECT_EQ(all.mesh().points, some.mesh().points);
  EXPECT_NE(all.mesh().points, mesh.points);
  EXPECT_EQ(some.mesh().tets.size(), mesh.tets.size());
  // The box finds both.
  const Vec3 at = Vec3(1, 1, 1) + move;
  EXPECT_EQ(some.improve(RemeshRegion::box(at, at)).removed_tets.size(), 0u);
}

TEST(TetOverlap, SharesOfAGridAddUp) {
  // Intersect random tets with the tets of a grid that covers them.
  const TetMesh grid = grid_mesh(3);
  Random random(10);
  for (int i = 0; i < 50; ++i) {
    TetCorners c;
    for (Vec3& p : c) p = Vec3(3 * random.uniform(), 3 * random.uniform(), 3 * random.uniform());
    double volume = orient3d_value(c[0], c[1], c[2], c[3]) / 6;
    if (volume < 0) std::swap(c[0], c[1]);
    volume = std::fabs(volume);
    double sum = 0;
    for (const Tet& t : grid.tets)
      sum += overlap_volume(PlanedTet(c), PlanedTet({grid.points[t[0]], grid.points[t[1]], grid.points[t[2]],
                                                     grid.points[t[3]]}));
    EXPECT_NEAR(sum, volume, 1e-13);
  }
}

}  // namespace
}  // namespace tetwright::remesher_test

// SPDX-License-Identifier: Apache-2.0

// Frozen parts are preserved by blocks of every operation.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "simplify/operations/collapse.h"
#include "simplify/operations/edge_removal.h"
#include "simplify/operations/face_removal.h"
#include "simplify/operations/fitting.h"
#include "simplify/operations/insertion.h"
#include "simplify/operations/smoothing.h"
#include "simplify/schedule/block_runner.h"
#include "tests/simplify/workbench.h"

namespace tetwright::frozen_test {
namespace {

using Place = std::array<double, 3>;

Place place(const EditableMesh& mesh, Index p) {
  const Vec3& at = mesh.position(p);
  return {at.x(), at.y(), at.z()};
}

template <std::size_t N>
std::array<Place, N> places(const EditableMesh& mesh, const std::array<Index, N>& ids) {
  std::array<Place, N> out;
  for (std::size_t k = 0; k < N; ++k) out[k] = place(mesh, ids[k]);
  std::sort(out.begin(), out.end());
  return out;
}

/// The parts that must not change: frozen points, and tets and faces between regions with only frozen points.
struct Kept {
  std::set<Place> points;
  std::set<std::pair<std::array<Place, 4>, MaterialTag>> tets;
  std::set<std::array<Place, 3>> faces;
};

Kept kept(const EditableMesh& mesh) {
  Kept k;
  for (Index t = 0; t < mesh.tet_slots(); ++t) {
    if (mesh.dead(t)) continue;
    for (Index p : mesh.points(t))
      if (mesh.frozen(p)) k.points.insert(place(mesh, p));
    if (mesh.frozen_tet(t)) k.tets.insert({places(mesh, mesh.points(t)), mesh.tag(mesh.region(t))});
    for (int f = 0; f < 4; ++f) {
      const Triangle ids = face_of(mesh.points(t), f);
      if (mesh.link(t, f).is_interface() &&
          std::all_of(ids.begin(), ids.end(), [&](Index p) { return mesh.frozen(p); }))
        k.faces.insert(places(mesh, ids));
    }
  }
  return k;
}

template <class Set>
bool includes(const Set& all, const Set& some) {
  return std::includes(all.begin(), all.end(), some.begin(), some.end());
}

/// Runs blocks of every operation several times and compares the frozen parts after each. Returns the number
/// of each operation done.
std::map<Operation, std::uint64_t> run_all(Workbench& w, const SurfaceProjection& projection) {
  const Kept before = kept(w.mesh);
  w.own_samples(0.5 * w.mesh.space().scale());
  BlockRunner runner(w.mesh, w.grid, w.ledger, 1, 0, nullptr);
  w.rules.acceptance.worse_probability = 0.5;
  w.rules.acceptance.worse_floor = 0.1f;
  w.rules.surface.projection = &projection;
  const auto no_stop = [] { return false; };
  std::map<Operation, std::uint64_t> done;
  const auto check = [&](Operation operation) {
    done[operation] += runner.take_totals().counts.of(operation, Outcome::done);
    w.expect_sound();
    const Kept now = kept(w.mesh);
    EXPECT_TRUE(now.points == before.points) << operation_names[static_cast<std::size_t>(operation)];
    EXPECT_TRUE(includes(now.tets, before.tets)) << operation_names[static_cast<std::size_t>(operation)];
    EXPECT_TRUE(includes(now.faces, before.faces)) << operation_names[static_cast<std::size_t>(operation)];
  };
  const auto stars = [&](Operation operation, const std::function<Outcome(Workspace&)>& act) {
    runner.points(
        w.live_points(),
        [&](Workspace& ws, Index p) {
          Outcome o = ws.gather(p);
          if (o == Outcome::done) o = act(ws);
          return ws.count(operation, o);
        },
        no_stop);
    check(operation);
  };
  const auto tets = [&](Operation operation, int count,
                        const std::function<Outcome(Workspace&, Index, int)>& act) {
    w.rules.count.max = w.mesh.live_tets() + 300;  // more would take too long
    std::vector<TetSnapshot> items;
    for (Index t = 0; t < w.mesh.tet_slots(); ++t)
      if (!w.mesh.dead(t)) items.push_back({t, w.mesh.points(t)});
    runner.tets(
        items,
        [&](Workspace& ws, const TetSnapshot& item, int) {
          if (!exists(w.mesh, item)) return Outcome::stale;
          for (int k = 0; k < count; ++k)
            if (act(ws, item.tet, k) == Outcome::done) return Outcome::done;
          return Outcome::no_candidate;
        },
        no_stop);
    check(operation);
  };
  for (int round = 0; round < 2; ++round) {
    w.rules.surface.leave_surface = round == 1;
    if (round == 1) w.rules.surface.max_distance = 0.1 * w.mesh.space().scale();
    stars(Operation::smooth, [&](Workspace& ws) { return smooth(ws, w.rules); });
    stars(Operation::optimise, [&](Workspace& ws) { return optimise(ws, w.rules); });
    stars(Operation::fit, [&](Workspace& ws) { return fit_to_samples(ws, w.rules, 0); });
    make_bad(w);
    for (const auto place : {InsertionPlace::best, InsertionPlace::centre}) {
      tets(Operation::insert_in_tet, 1,
           [&](Workspace& ws, Index t, int) { return insert_in_tet(ws, w.rules, t, place); });
      tets(Operation::insert_in_face, 4,
           [&](Workspace& ws, Index t, int f) { return insert_in_face(ws, w.rules, t, f, place); });
      tets(Operation::insert_in_edge, 6,
           [&](Workspace& ws, Index t, int e) { return insert_in_edge(ws, w.rules, t, e, place, true); });
      make_bad(w);
    }
    tets(Operation::edge_removal, 6,
         [&](Workspace& ws, Index t, int e) { return remove_edge(ws, w.rules, t, e, full_reach); });
    make_bad(w);
    tets(Operation::face_removal, 4,
         [&](Workspace& ws, Index t, int f) { return remove_face(ws, w.rules, t, f, full_reach); });
    make_bad(w);
    for (int k = 0; k < 4; ++k)
      stars(Operation::collapse, [&](Workspace& ws) { return collapse(ws, w.rules); });
  }
  return done;
}

TetMesh two_materials() {
  TetMesh mesh =
      grid_mesh({6, 6, 6}, [](int x, int, int) { return std::optional<MaterialTag>(x < 3 ? 1 : 2); });
  jitter(mesh, 6, 0.3);
  return mesh;
}

TEST(Frozen, PointsOfTheMaskStayWithTheirTets) {
  const TetMesh mesh = two_materials();
  std::vector<std::uint8_t> mask(mesh.points.size(), 0);
  Random random(3);
  std::size_t frozen = 0;
  for (std::size_t p = 0; p < mask.size(); ++p) {
    // Freeze a whole corner of the mesh, and scattered points.
    mask[p] = mesh.points[p].maxCoeff() < 3.5 || random.below(12) == 0;
    frozen += mask[p];
  }
  Workbench w(mesh, [&](EditableMesh& m) { m.freeze(mask); });
  const SurfaceProjection projection(w.mesh, nullptr);
  ASSERT_EQ(kept(w.mesh).points.size(), frozen);
  ASSERT_GT(kept(w.mesh).tets.size(), 100u);
  for (const auto& [operation, done] : run_all(w, projection))
    EXPECT_GT(done, 0u) << operation_names[static_cast<std::size_t>(operation)];
  EXPECT_TRUE(kept(w.mesh).points.size() == frozen);
}

TEST(Frozen, FacesOfBoundaryAndInterfacesStay) {
  Workbench w(two_materials(), [](EditableMesh& m) { m.freeze_interfaces(); });
  const SurfaceProjection projection(w.mesh, nullptr);
  const std::size_t faces = kept(w.mesh).faces.size();
  ASSERT_EQ(faces, 6u * 2 * 36 + 2 * 36);
  EXPECT_EQ(kept(w.mesh).tets.size(), 0u);  // their tets may change
  const auto done = run_all(w, projection);
  for (const Operation inner : {Operation::collapse, Operation::optimise, Operation::insert_in_tet,
                                Operation::insert_in_edge, Operation::edge_removal})
    EXPECT_GT(done.at(inner), 0u) << operation_names[static_cast<std::size_t>(inner)];
  EXPECT_EQ(done.at(Operation::fit), 0u);
  EXPECT_EQ(done.at(Operation::insert_in_face), 0u);
  EXPECT_EQ(kept(w.mesh).faces.size(), faces);  // and none was added
  EXPECT_EQ(w.grid.triangles().size(), faces);
}

// Without a mask everything moves.
TEST(Frozen, NothingIsWithoutAMask) {
  Workbench w(two_materials());
  EXPECT_FALSE(w.mesh.any_frozen());
  const SurfaceProjection projection(w.mesh, nullptr);
  std::set<Place> before, after;
  for (Index p : w.live_points()) before.insert(place(w.mesh, p));
  run_all(w, projection);
  for (Index p : w.live_points()) after.insert(place(w.mesh, p));
  std::vector<Place> both;
  std::set_intersection(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(both));
  EXPECT_LT(both.size(), before.size() / 4);
}

}  // namespace
}  // namespace tetwright::frozen_test

// SPDX-License-Identifier: Apache-2.0

// Ten thousand random operations on small meshes of several materials, validated after each.
#include "common/mesh/mesh_check.h"
#include "common/mesh/topology.h"
#include "simplify/operations/collapse.h"
#include "simplify/operations/edge_removal.h"
#include "simplify/operations/face_removal.h"
#include "simplify/operations/fitting.h"
#include "simplify/operations/insertion.h"
#include "simplify/operations/smoothing.h"
#include "tests/simplify/workbench.h"

namespace tetwright::random_operations_test {
namespace {

using Tag = std::optional<MaterialTag>;

/// The current mesh, with as many points as slots.
TetMesh snapshot(const EditableMesh& mesh) {
  TetMesh out;
  std::vector<Index> number(mesh.point_slots(), no_index);
  for (Index t = 0; t < mesh.tet_slots(); ++t) {
    if (mesh.dead(t)) continue;
    Tet ids;
    for (int k = 0; k < 4; ++k) {
      if (number[mesh.points(t)[k]] == no_index) {
        number[mesh.points(t)[k]] = static_cast<Index>(out.points.size());
        out.points.push_back(mesh.space().to_input(mesh.position(mesh.points(t)[k])));
      }
      ids[k] = number[mesh.points(t)[k]];
    }
    out.tets.push_back(ids);
    out.materials.push_back(mesh.tag(mesh.region(t)));
  }
  return out;
}

const std::array<Tag (*)(int, int, int), 5> materials{
    [](int, int, int) { return Tag(1); }, [](int x, int, int) { return Tag(x < 2 ? 1 : 2); },
    [](int x, int y, int z) {
      return Tag(z < 1 ? 1 : x < 2 ? 2 : y < 2 ? 3 : 4);
    },
    [](int x, int y, int z) { return x == 1 && y == 1 && z == 1 ? Tag() : Tag(z < 2 ? 5 : 9); },
    [](int x, int y, int z) { return x == 1 && y == 1 ? Tag() : Tag(z == 1 ? 2 : 1); }};

/// Tries a random operation on the tet.
Outcome random_operation(Workbench& w, Index t, const SurfaceProjection& projection) {
  Workspace& ws = *w.ws;
  Random& random = ws.random;
  BlockRules rules = w.rules;
  rules.accept_worse = random.uniform() < 0.5 ? 1 : 0;
  rules.good_enough = random.uniform() < 0.3 ? 0.05f : 1;
  if (random.below(2)) {
    rules.projection = &projection;
    rules.max_distance = 0.2;
    rules.leave_surface = random.below(2);
  }
  const auto place = random.below(2) ? InsertionPlace::best : InsertionPlace::centre;
  const FlipReach reach = random.below(2) ? FlipReach{7, 5} : FlipReach{3, 1};
  const Tet points = w.mesh.points(t);
  const auto star = [&] { return ws.gather(points[random.below(4)]); };
  switch (random.below(10)) {
    case 0:
      return remove_edge(ws, rules, t, static_cast<int>(random.below(6)), reach);
    case 1:
      return remove_face(ws, rules, t, static_cast<int>(random.below(4)), reach);
    case 2:
    case 3:
      return star() == Outcome::done ? collapse(ws, rules) : Outcome::no_candidate;
    case 4:
      return star() == Outcome::done ? smooth(ws, rules) : Outcome::no_candidate;
    case 5:
      return star() == Outcome::done ? optimise(ws, rules) : Outcome::no_candidate;
    case 6:
      return star() == Outcome::done ? fit_to_samples(ws, rules, 0) : Outcome::no_candidate;
    case 7:
      return insert_in_tet(ws, rules, t, place);
    case 8:
      return insert_in_face(ws, rules, t, static_cast<int>(random.below(4)), place);
    default:
      return insert_in_edge(ws, rules, t, static_cast<int>(random.below(6)), place, true);
  }
}

TEST(RandomOperations, TenThousandLeaveEveryMeshSoundAndItsTopologyAsItWas) {
  constexpr int operations_per_mesh = 500, rounds = 4;
  std::size_t done = 0, tried = 0;
  for (int round = 0; round < rounds; ++round)
    for (std::size_t m = 0; m < materials.size(); ++m) {
      const std::uint64_t seed = 100 * static_cast<std::uint64_t>(round) + m;
      SCOPED_TRACE(testing::Message() << "seed " << seed);
      TetMesh mesh = grid_mesh({4, 3, 3}, materials[m]);
      jitter(mesh, seed, 0.3);
      const Topology before = topology(mesh);
      Workbench w(mesh);
      w.mesh.compact(4096, 1024);
      w.grid.build(w.mesh, 0);
      w.own_samples(w.mesh.space().scale());
      if (round % 2) w.rules.max_deviation = 0.3 * w.mesh.space().scale();
      w.ws = std::make_unique<Workspace>(w.mesh, w.grid, w.ledger);
      w.ws->random = Random(seed);
      w.rules.objective.kind = seed % 2 ? Objective::Kind::shape : Objective::Kind::paper;
      w.rules.count.max = 2 * mesh.tets.size();
      const SurfaceProjection projection(w.mesh, nullptr);
      for (int i = 0; i < operations_per_mesh; ++i) {
        Index t;
        do {
          t = w.ws->random.below(static_cast<std::uint32_t>(w.mesh.tet_slots()));
        } while (w.mesh.dead(t));
        const Outcome o = w.carry_out(random_operation(w, t, projection));
        ++tried;
        if (o != Outcome::done) continue;
        ++done;
        ASSERT_TRUE(w.mesh.links_consistent());
        const TetMesh now = snapshot(w.mesh);
        for (const MeshFinding& f : check_mesh(now))
          FAIL() << "operation " << i << ": " << mesh_finding_line(f);
        for (const std::string& d : topology_differences(before, topology(now)))
          FAIL() << "operation " << i << ": " << d;
      }
      w.expect_sound();
      if (round % 2) {
        EXPECT_LE(w.samples->largest_distance(), w.rules.max_deviation);
      }
    }
  EXPECT_EQ(tried, 10000u);
  EXPECT_GT(done, 1500u);
}

}  // namespace
}  // namespace tetwright::random_operations_test

// SPDX-License-Identifier: Apache-2.0

// Ten thousand random operations on small meshes of several materials, validated after each.
#include "simplify/operations/collapse.h"
#include "simplify/operations/edge_removal.h"
#include "simplify/operations/face_removal.h"
#include "simplify/operations/fitting.h"
#include "simplify/operations/insertion.h"
#include "simplify/operations/smoothing.h"
#include "tests/simplify/workbench.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/sheets.h"

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
  append_sheets(out.interfaces, mesh.sheets(number));
  return out;
}

/// Adds the faces inside materials whose corners all satisfy `on` to the mesh as a sheet.
void add_sheet(TetMesh& mesh, bool (*on)(const Vec3&)) {
  if (mesh.interfaces.empty()) mesh.interfaces = find_interfaces(mesh);
  std::vector<InterfaceTriangle> sheet;
  for (const MeshFace& f : mesh_faces(mesh.tets, mesh.points.size()))
    if (f.count == 2 && mesh.materials[f.first] == mesh.materials[f.second] &&
        std::all_of(f.ids.begin(), f.ids.end(), [&](Index p) { return on(mesh.points[p]); }))
      sheet.push_back({f.ids, mesh.materials[f.first], mesh.materials[f.first]});
  ASSERT_FALSE(sheet.empty());
  append_sheets(mesh.interfaces, std::move(sheet));
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
  rules.acceptance.worse_probability = random.uniform() < 0.5 ? 1 : 0;
  if (random.uniform() < 0.3) rules.acceptance.good_enough = 0.05f;
  if (random.below(2)) {
    rules.surface.projection = &projection;
    rules.surface.max_distance = 0.2;
    rules.surface.leave_surface = random.below(2);
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

/// Operations tried and carried out.
struct Counts {
  std::size_t tried = 0, done = 0;
};

/// Carries out random operations on the mesh and validates it after each.
void operate(const TetMesh& mesh, std::uint64_t seed, bool bounded, Counts& counts) {
  constexpr int operations = 500;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  const Topology before = topology(mesh);
  Workbench w(mesh);
  w.mesh.compact(4096, 1024);
  w.grid.build(w.mesh);
  w.own_samples(w.mesh.space().scale());
  if (bounded) w.rules.deviation.max = 0.3 * w.mesh.space().scale();
  w.ws = std::make_unique<Workspace>(w.mesh, w.grid, w.ledger);
  w.ws->random = Random(seed);
  w.rules.objective.kind = seed % 2 ? Objective::Kind::shape : Objective::Kind::paper;
  w.rules.count.max = 2 * mesh.tets.size();
  const SurfaceProjection projection(w.mesh, nullptr);
  for (int i = 0; i < operations; ++i) {
    Index t;
    do {
      t = w.ws->random.below(static_cast<std::uint32_t>(w.mesh.tet_slots()));
    } while (w.mesh.dead(t));
    const Outcome o = w.carry_out(random_operation(w, t, projection));
    ++counts.tried;
    if (o != Outcome::done) continue;
    ++counts.done;
    ASSERT_TRUE(w.mesh.links_consistent());
    const TetMesh now = snapshot(w.mesh);
    for (const MeshFinding& f : check_mesh(now)) FAIL() << "operation " << i << ": " << mesh_finding_line(f);
    for (const std::string& d : topology_differences(before, topology(now)))
      FAIL() << "operation " << i << ": " << d;
  }
  w.expect_sound();
  if (bounded) {
    EXPECT_LE(w.samples->largest_distance(), *w.rules.deviation.max);
  }
}

TEST(RandomOperations, TenThousandLeaveEveryMeshSoundAndItsTopologyAsItWas) {
  constexpr int rounds = 4;
  Counts counts;
  for (int round = 0; round < rounds; ++round)
    for (std::size_t m = 0; m < materials.size(); ++m) {
      const std::uint64_t seed = 100 * static_cast<std::uint64_t>(round) + m;
      TetMesh mesh = grid_mesh({4, 3, 3}, materials[m]);
      jitter(mesh, seed, 0.3);
      operate(mesh, seed, round % 2, counts);
      if (HasFatalFailure()) return;
    }
  EXPECT_EQ(counts.tried, 10000u);
  EXPECT_GT(counts.done, 1500u);
}

TEST(RandomOperations, LeaveSheetsWhereverTheyEndAsTheyWere) {
  /// Within the material, from wall to wall, ending at a wall, and two that meet in a curve.
  constexpr std::array<bool (*)(const Vec3&), 4> sheets{
      [](const Vec3& p) { return p.z() == 2 && p.x() >= 1 && p.x() <= 3 && p.y() >= 1 && p.y() <= 3; },
      [](const Vec3& p) { return p.z() == 2; }, [](const Vec3& p) { return p.z() == 2 && p.x() <= 2; },
      [](const Vec3& p) { return (p.z() == 2 && p.x() <= 2) || (p.x() == 2 && p.z() >= 1 && p.z() <= 3); }};
  constexpr int rounds = 4;
  Counts counts;
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < sheets.size(); ++i) {
      const std::uint64_t seed = 1000 + 100 * static_cast<std::uint64_t>(round) + i;
      TetMesh mesh = grid_mesh({4, 4, 4}, materials[round % 2]);
      add_sheet(mesh, sheets[i]);
      jitter(mesh, seed, 0.3);
      operate(mesh, seed, round % 2, counts);
      if (HasFatalFailure()) return;
    }
  EXPECT_GT(counts.done, 1000u);
}

}  // namespace
}  // namespace tetwright::random_operations_test

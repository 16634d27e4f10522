// SPDX-License-Identifier: Apache-2.0

// Fuzzes the operations of the simplifier: the bytes of the input choose a mesh of several materials,
// followed by tets and operations on them. After each operation that changed it, the mesh must be valid and
// have its original topology.
#include <array>
#include <cstdint>
#include <memory>

#include "simplify/constraints/surface_samples.h"
#include "simplify/operations/collapse.h"
#include "simplify/operations/edge_removal.h"
#include "simplify/operations/face_removal.h"
#include "simplify/operations/fitting.h"
#include "simplify/operations/insertion.h"
#include "simplify/operations/smoothing.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/targets.h"
#include "tests/simplify/meshes.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::fuzz {
namespace {

TetMesh choose_mesh(Bytes& bytes) {
  const std::uint32_t kind = bytes.below(4);
  TetMesh mesh = grid_mesh({3, 3, 3}, [kind](int x, int y, int z) -> std::optional<MaterialTag> {
    if (kind == 1) return x < 2 ? 1 : 2;
    if (kind == 2) return z < 1 ? 1 : x < 2 ? 2 : y < 2 ? 3 : 4;
    if (kind == 3 && x == 1 && y == 1 && z == 1) return {};
    return 1;
  });
  jitter(mesh, bytes.below(256), 0.3);
  return mesh;
}

/// Live tets as a plain mesh.
TetMesh snapshot(const EditableMesh& mesh) {
  TetMesh out;
  std::vector<Index> number(mesh.point_slots(), no_index);
  for (Index t = 0; t < mesh.tet_slots(); ++t) {
    if (mesh.dead(t)) continue;
    Tet ids = mesh.points(t);
    for (Index& p : ids) {
      if (number[p] == no_index) {
        number[p] = static_cast<Index>(out.points.size());
        out.points.push_back(mesh.space().to_input(mesh.position(p)));
      }
      p = number[p];
    }
    out.tets.push_back(ids);
    out.materials.push_back(mesh.tag(mesh.region(t)));
  }
  return out;
}

Outcome operate(Workspace& ws, BlockRules rules, Bytes& bytes, Index t) {
  rules.acceptance.worse_probability = bytes.below(2);
  const FlipReach reach = bytes.below(2) ? full_reach : basic_reach;
  const auto place = bytes.below(2) ? InsertionPlace::best : InsertionPlace::centre;
  const Tet points = ws.mesh.points(t);
  const auto gather = [&] { return ws.gather(points[bytes.below(4)]) == Outcome::done; };
  switch (bytes.below(9)) {
    case 0:
      return remove_edge(ws, rules, t, static_cast<int>(bytes.below(6)), reach);
    case 1:
      return remove_face(ws, rules, t, static_cast<int>(bytes.below(4)), reach);
    case 2:
      return gather() ? collapse(ws, rules) : Outcome::no_candidate;
    case 3:
      return gather() ? smooth(ws, rules) : Outcome::no_candidate;
    case 4:
      return gather() ? optimise(ws, rules) : Outcome::no_candidate;
    case 5:
      return gather() ? fit_to_samples(ws, rules, 0) : Outcome::no_candidate;
    case 6:
      return insert_in_tet(ws, rules, t, place);
    case 7:
      return insert_in_face(ws, rules, t, static_cast<int>(bytes.below(4)), place);
    default:
      return insert_in_edge(ws, rules, t, static_cast<int>(bytes.below(6)), place, true);
  }
}

}  // namespace

void run_operations(std::string_view input_bytes) {
  constexpr int max_operations = 100;
  Bytes bytes(input_bytes);
  TetMesh input = choose_mesh(bytes);
  const Topology before = topology(input);
  EditableMesh mesh(std::move(input), "fuzz");
  mesh.compact(2048, 512);
  SurfaceGrid grid;
  grid.build(mesh);
  const RepresentedSurface surface(mesh, nullptr);
  SurfaceSamples samples(mesh, grid.record_count(), surface, mesh.space().scale());
  grid.set_samples(&samples);
  VolumeLedger ledger;
  BlockRules rules;
  rules.objective.quality = TetQuality::for_target(mesh.total_volume(), 1);
  rules.objective.kind = bytes.below(2) ? Objective::Kind::shape : Objective::Kind::paper;
  rules.error.max = 1e9;
  rules.count.max = 2 * mesh.live_tets();
  for (Index t = 0; t < mesh.tet_slots(); ++t)
    if (!mesh.dead(t)) mesh.set_quality(t, quality_of(mesh, rules, mesh.points(t)));
  Workspace ws(mesh, grid, ledger);
  CommitWorkspace commit_workspace;
  for (int i = 0; i < max_operations && !bytes.empty(); ++i) {
    const Index t = (bytes.below(256) << 8 | bytes.below(256)) % static_cast<Index>(mesh.tet_slots());
    if (mesh.dead(t)) continue;
    ws.proposal.clear();
    if (operate(ws, rules, bytes, t) != Outcome::done) continue;
    commit_alone(mesh, grid, ws.proposal, commit_workspace);
    TETWRIGHT_CHECK(mesh.links_consistent());
    const TetMesh now = snapshot(mesh);
    TETWRIGHT_CHECK(check_mesh(now).empty());
    TETWRIGHT_CHECK(topology_differences(before, topology(now)).empty());
  }
}

}  // namespace tetwright::fuzz

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "common/geometry/predicates.h"
#include "simplify/constraints/surface_samples.h"
#include "simplify/operations/workspace.h"
#include "tests/simplify/meshes.h"

namespace tetwright {

/// One worker on one mesh, for tests of single operations.
struct Workbench {
  /// \param prepare is called before the points are renumbered.
  explicit Workbench(
      const TetMesh& input, const std::function<void(EditableMesh&)>& prepare = [](EditableMesh&) {})
      : mesh(TetMesh(input), "mesh") {
    prepare(mesh);
    mesh.compact(64, 32);
    rules.objective.quality = TetQuality::for_target(mesh.total_volume(), 1);
    rules.error.max = 1e9;
    for (Index t = 0; t < mesh.tet_slots(); ++t) {
      const Tet& p = mesh.points(t);
      if (p[0] != no_index)
        mesh.set_quality(t, rules.objective(mesh.position(p[0]), mesh.position(p[1]), mesh.position(p[2]),
                                            mesh.position(p[3])));
    }
    grid.build(mesh);
    ws = std::make_unique<Workspace>(mesh, grid, ledger);
  }

  /// The point at a position in input units.
  Index at(double x, double y, double z) const {
    for (Index p : live_points())
      if ((mesh.space().to_input(mesh.position(p)) - Vec3(x, y, z)).norm() < 1e-12) return p;
    ADD_FAILURE() << "no point at " << x << ' ' << y << ' ' << z;
    return 0;
  }

  /// The live points.
  std::vector<Index> live_points() const {
    std::vector<Index> out;
    for (Index p = 0; p < mesh.point_slots(); ++p)
      if (mesh.incident_tet(p) != no_index) out.push_back(p);
    return out;
  }

  /// The star of a point, with an empty proposal.
  Star& star(Index p) {
    ws->proposal.clear();
    EXPECT_EQ(ws->gather(p), Outcome::done);
    return ws->star;
  }

  /// Processes an operation's outcome as BlockRunner does, in a batch of one: carries out the proposal.
  Outcome carry_out(Outcome answer) {
    last = {};
    std::swap(last, ws->proposal);
    if (answer != Outcome::done) return answer;
    EXPECT_TRUE(ledger.allows(last.volumes));
    EXPECT_TRUE(last.count_bounds.allow(mesh.live_tets(), last.count_change));
    EXPECT_EQ(mesh.live_tets(), count_live());  // deciding wrote nothing
    begin_batch({&last});
    EXPECT_TRUE(admit(last));
    commit(mesh, grid, last, commit_workspace);
    end_batch();
    ws->counts.add(last.operation, Outcome::done);
    return answer;
  }

  /// Assigns to the triangles samples of `surface` (input units) or, if null, of the mesh's own surface.
  /// \pre The grid is as built.
  void own_samples(double edge, const TriangleMesh* surface = nullptr) {
    input_surface = std::make_unique<RepresentedSurface>(mesh, surface);
    samples = std::make_unique<SurfaceSamples>(mesh, grid.record_count(), *input_surface, edge);
    grid.set_samples(samples.get());
  }

  // The steps of a batch, for several proposals.

  void begin_batch(const std::vector<Proposal*>& proposals) {
    std::size_t tets = 0, points = 0;
    for (const Proposal* p : proposals) {
      tets += p->added.size();
      points += p->has_new_point;
    }
    tetwright::begin_batch(mesh, proposals.size(), tets, points);
  }
  /// Whether the proposal wins. If so, it has claimed its write set and taken its slots.
  bool admit(Proposal& p) {
    if (!mesh.reservations().free(p.read_set())) return false;
    ledger.commit(p.volumes);
    grant(mesh, grid, p);
    return true;
  }
  void end_batch() { tetwright::end_batch(mesh, grid); }

  std::size_t count_live() const {
    std::size_t count = 0;
    for (Index t = 0; t < mesh.tet_slots(); ++t) count += !mesh.dead(t);
    return count;
  }

  /// Expects consistent links and counts, positive tets, a triangle in the grid for each face between
  /// regions, and no slot both free and in use.
  void expect_sound() {
    EXPECT_TRUE(mesh.links_consistent());
    std::vector<Triangle> interfaces;
    for (Index t = 0; t < mesh.tet_slots(); ++t) {
      if (mesh.dead(t)) continue;
      const Tet& p = mesh.points(t);
      EXPECT_EQ(orient3d(mesh.position(p[0]), mesh.position(p[1]), mesh.position(p[2]), mesh.position(p[3])),
                1);
      for (int f = 0; f < 4; ++f) {
        const Index other = mesh.neighbour(t, f);
        if (!mesh.link(t, f).is_interface() || (other != no_index && other < t)) continue;
        Triangle ids;
        for (int k = 0; k < 3; ++k) ids[k] = mesh.original(p[tet_faces[f][k]]);
        std::sort(ids.begin(), ids.end());
        interfaces.push_back(ids);
      }
    }
    std::vector<Triangle> listed;
    for (const MeshTriangle& t : grid.triangles()) {
      listed.push_back(t.ids);
      for (int k = 0; k < 3; ++k) EXPECT_EQ(t.points[k], mesh.position(t.ids[k]));
    }
    std::sort(interfaces.begin(), interfaces.end());
    std::sort(listed.begin(), listed.end());
    EXPECT_EQ(listed, interfaces);
    EXPECT_EQ(mesh.free_tets().available(), mesh.tet_slots() - mesh.live_tets());
    EXPECT_EQ(mesh.free_points().available(), mesh.point_slots() - live_points().size());
  }

  EditableMesh mesh;
  SurfaceGrid grid;
  std::unique_ptr<RepresentedSurface> input_surface;
  std::unique_ptr<SurfaceSamples> samples;
  VolumeLedger ledger;  ///< no bounds unless opened
  BlockRules rules;
  std::unique_ptr<Workspace> ws;
  Proposal last;  ///< last proposal carried out
  CommitWorkspace commit_workspace;
};

/// Gives every tet the worst quality: any positive tet is better.
inline void make_bad(Workbench& w) {
  for (Index t = 0; t < w.mesh.tet_slots(); ++t)
    if (!w.mesh.dead(t)) w.mesh.set_quality(t, 0);
}

}  // namespace tetwright

#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "common/geometry/predicates.h"
#include "simplify/operations/workspace.h"
#include "tests/simplify/meshes.h"

namespace tetwright {

/// One task on one mesh, for tests of single operations.
struct Workbench {
  explicit Workbench(const TetMesh& input) : mesh(TetMesh(input), "mesh") {
    mesh.compact(64, 32);
    rules.objective.quality = TetQuality::for_target(mesh.total_volume(), 1);
    rules.max_error = 1e9;
    for (Index t = 0; t < mesh.tet_slots(); ++t) {
      const Tet& p = mesh.tet(t).points;
      if (p[0] != no_index)
        mesh.set_quality(t, rules.objective(mesh.position(p[0]), mesh.position(p[1]), mesh.position(p[2]),
                                            mesh.position(p[3])));
    }
    grid.build(mesh, 0, 64);
    ws = std::make_unique<Workspace>(mesh, grid, ledger);
  }

  /// The point at a place given in input units.
  Index at(double x, double y, double z) const {
    for (Index p : live_points())
      if ((mesh.space().to_input(mesh.position(p)) - Vec3(x, y, z)).norm() < 1e-12) return p;
    ADD_FAILURE() << "no point at " << x << ' ' << y << ' ' << z;
    return 0;
  }

  /// The points that are there.
  std::vector<Index> live_points() const {
    std::vector<Index> out;
    for (Index p = 0; p < mesh.point_slots(); ++p)
      if (mesh.incident_tet(p) != no_index) out.push_back(p);
    return out;
  }

  /// The star of a point, held.
  Star& star(Index p) {
    ws->release();
    EXPECT_TRUE(ws->points.try_lock(p));
    EXPECT_EQ(ws->star.gather(mesh, p, ws->points), Outcome::done);
    return ws->star;
  }

  /// Everything given back, links sound, all tets positive, as many triangles in the grid as faces between
  /// regions.
  void expect_sound() {
    EXPECT_EQ(ws->cells.count(), 0u);  // no operation leaves a cell of the grid held
    ws->release();
    EXPECT_TRUE(mesh.locks().all_free());
    EXPECT_TRUE(grid.locks().all_free());
    EXPECT_TRUE(mesh.links_consistent());
    std::vector<Triangle> interfaces;
    for (Index t = 0; t < mesh.tet_slots(); ++t) {
      const TetRecord& r = mesh.tet(t);
      if (r.points[0] == no_index) continue;
      EXPECT_EQ(orient3d(mesh.position(r.points[0]), mesh.position(r.points[1]), mesh.position(r.points[2]),
                         mesh.position(r.points[3])),
                1);
      for (int f = 0; f < 4; ++f) {
        const Index other = r.neighbours[f];
        if (other != no_index && (other < t || mesh.tet(other).region == r.region)) continue;
        Triangle ids;
        for (int k = 0; k < 3; ++k) ids[k] = mesh.original(r.points[tet_faces[f][k]]);
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
  }

  EditableMesh mesh;
  SurfaceGrid grid;
  VolumeLedger ledger;  ///< no bounds unless opened
  BlockRules rules;
  std::unique_ptr<Workspace> ws;
};

/// As if every tet were as poor as can be: any positive ones are better.
inline void make_poor(Workbench& w) {
  for (Index t = 0; t < w.mesh.tet_slots(); ++t)
    if (!w.mesh.dead(t)) w.mesh.set_quality(t, 0);
}

/// Locks the four points of a tet.
inline void lock_tet(Workbench& w, Index t) {
  for (Index p : w.mesh.tet(t).points) ASSERT_TRUE(w.ws->points.try_lock(p));
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/tet_mesh.h"
#include "simplify/operations/workspace.h"

namespace tetwright {

/// What an ordering of collapses cost.
struct StrategyCounts {
  std::uint64_t weights = 0;  ///< collapses evaluated: Weight = length + Error of a half-edge
  std::uint64_t tests = 0;  ///< collapses whose legality was tested: signs, quality, link condition, surface
  std::uint64_t stars = 0;  ///< closed stars gathered for that
  std::uint64_t collapses = 0;  ///< carried out
};

/// A half-edge: `origin` is drawn onto `target`.
struct WeighedCollapse {
  double weight;
  Index origin, target;
};

/// A mesh on its way to a target, with the pieces of simplify/ that both orderings are made of. One thread.
class Workpiece {
 public:
  Workpiece(TetMesh mesh, std::size_t target_tets);

  bool reached() const { return mesh.live_tets() <= target; }
  bool alive(Index point) const { return mesh.incident_tet(point) != no_index; }
  /// Quality(t)^3 of every tet.
  void rate_all();

  /// Gathers the star of a living point; false where it is too large for an operation.
  bool gather(Workspace& ws, Index point);
  /// Appends the weights of all half-edges that begin at the gathered star's centre and that dimensions and
  /// materials allow; only those to a point for which `wanted` is true.
  void weigh(
      Workspace& ws, std::vector<WeighedCollapse>& out,
      const std::function<bool(Index)>& wanted = [](Index) { return true; });
  /// Whether a collapse of the gathered star's centre is legal; then it is proposed.
  bool propose(Workspace& ws, Index onto);
  /// Carries out what was proposed.
  void carry_out(Workspace& ws);

  TetMesh result() && { return std::move(mesh).to_mesh(); }

  EditableMesh mesh;
  SurfaceGrid grid;
  BlockRules rules;
  StrategyCounts counts;
  std::size_t target;

 private:
  CommitWorkspace commit_workspace_;
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/tet_mesh.h"
#include "simplify/operations/workspace.h"

namespace tetwright {

/// Cost of an ordering of collapses.
struct StrategyCounts {
  std::uint64_t weights = 0;  ///< collapses evaluated: Weight = length + Error of a half-edge
  std::uint64_t tests = 0;  ///< collapses whose legality was tested: signs, quality, link condition, surface
  std::uint64_t stars = 0;  ///< closed stars gathered for that
  std::uint64_t collapses = 0;  ///< carried out
};

/// A half-edge: `origin` collapses onto `target`.
struct WeighedCollapse {
  double weight;
  Index origin, target;
};

/// A mesh that is being simplified, with the parts of simplify/ that both orderings share. One thread.
class Workpiece {
 public:
  Workpiece(TetMesh mesh, std::size_t target_tets);

  bool reached() const { return mesh.live_tets() <= target; }
  bool alive(Index point) const { return mesh.incident_tet(point) != no_index; }
  /// Quality(t)^3 of every tet.
  void rate_all();

  /// Gathers the star of a live point; false if it is too large for an operation.
  bool gather(Workspace& ws, Index point);
  /// Appends the weights of all half-edges from the gathered star's centre that dimensions and materials
  /// allow, to points for which `wanted` is true.
  void weigh(
      Workspace& ws, std::vector<WeighedCollapse>& out,
      const std::function<bool(Index)>& wanted = [](Index) { return true; });
  /// Proposes the collapse of the gathered star's centre if it is legal; returns whether it is.
  bool propose(Workspace& ws, Index onto);
  /// Carries out the proposal.
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

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "simplify/operations/workspace.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Cost of an order of collapses.
struct StrategyCounts {
  std::uint64_t weights = 0;  ///< collapses evaluated: Weight = length + Error of a half-edge
  std::uint64_t tests = 0;  ///< collapses whose legality was tested: signs, quality, link condition, surface
  std::uint64_t stars = 0;  ///< closed stars gathered for these tests
  std::uint64_t collapses = 0;  ///< collapses carried out
};

/// A half-edge: `origin` collapses onto `target`.
struct WeighedCollapse {
  double weight;
  Index origin, target;
};

/// A mesh that is being simplified, with the parts of simplify/ that both orders use. Single-threaded.
class Workpiece {
 public:
  Workpiece(TetMesh mesh, std::size_t target_tets);

  bool reached() const { return mesh.live_tets() <= target; }
  bool alive(Index point) const { return mesh.incident_tet(point) != no_index; }
  /// Computes Quality(t)^3 of every tet.
  void rate_all();

  /// Gathers the star of a live point.
  /// \return false if it is too large for an operation
  bool gather(Workspace& ws, Index point);
  /// Appends the weights of all half-edges from the centre of the gathered star that dimensions and materials
  /// allow, to points for which `wanted` is true.
  void weigh(
      Workspace& ws, std::vector<WeighedCollapse>& out,
      const std::function<bool(Index)>& wanted = [](Index) { return true; });
  /// Proposes the collapse of the gathered star's centre if it is legal.
  /// \return whether it is legal
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

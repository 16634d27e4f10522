#pragma once

#include <vector>

#include "simplify/remesh/local_area.h"

namespace tetwright {

/// What one call of a Remesher does in its region.
class RemeshRounds {
 public:
  struct Plan {
    double poor_angle;           ///< steradians: tets whose shape is worse than it stands for are improved
    double leave_surface_angle;  ///< likewise: points of surfaces may leave them a little
    float floor;                 ///< shape_quality() that coarsening and refining leave
  };
  /// `region`: living tets, each once; `with_rim`: all that share points with them. `journal`
  /// takes down what changes.
  RemeshRounds(EditableMesh& mesh, BlockRunner& runner, ChangeJournal& journal, const BlockRules& rules,
               const Plan& plan, const std::vector<Index>& region, const std::vector<Index>& with_rim);

  /// Lengths in working coordinates.
  void coarsen(double size);
  void refine(double size);
  /// What is poor of the region, or, with the rim around it, of what coarsen() and refine() have changed.
  void improve();
  /// Operations that were carried out.
  std::uint64_t operations() const { return area_.operations(); }

 private:
  EditableMesh& mesh_;
  BlockRunner& runner_;
  BlockRules rules_;
  Plan plan_;
  std::vector<Index> region_;
  LocalArea area_;
};

}  // namespace tetwright

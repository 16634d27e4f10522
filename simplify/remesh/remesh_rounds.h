// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simplify/remesh/local_area.h"
#include "simplify/schedule/improvement.h"

namespace tetwright {

/// What one call of a Remesher does in its region.
class RemeshRounds {
 public:
  /// `region`: living tets, each once; `with_rim`: all that share points with them. `journal`
  /// takes down what changes. `tools.rules` are copied.
  RemeshRounds(const ImprovementTools& tools, ChangeJournal& journal, const std::vector<Index>& region,
               const std::vector<Index>& with_rim);

  RemeshRounds(const RemeshRounds&) = delete;
  RemeshRounds& operator=(const RemeshRounds&) = delete;

  /// `size` in working coordinates; `floor`: the shape_quality() that they leave.
  void coarsen(double size, float floor);
  void refine(double size, float floor);
  /// What is bad of the region, or, with the rim around it, of what coarsen() and refine() have changed.
  /// Returns the number of rounds.
  int improve(const ImprovementPlan& plan);
  /// Operations that were carried out.
  std::uint64_t operations() const { return area_.operations(); }

 private:
  BlockRules rules_;
  ImprovementTools tools_;
  std::vector<Index> region_;
  LocalArea area_;
};

}  // namespace tetwright

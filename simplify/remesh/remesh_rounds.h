// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simplify/remesh/local_area.h"
#include "simplify/schedule/improvement.h"

namespace tetwright {

/// The work of one Remesher call on its region.
class RemeshRounds {
 public:
  /// \param tools its rules are copied.
  /// \param journal records the changes.
  /// \param region live tets, each once.
  /// \param with_rim all tets that share points with them.
  RemeshRounds(const ImprovementTools& tools, ChangeJournal& journal, const std::vector<Index>& region,
               const std::vector<Index>& with_rim);

  RemeshRounds(const RemeshRounds&) = delete;
  RemeshRounds& operator=(const RemeshRounds&) = delete;

  /// \param size target edge length, working coordinates.
  /// \param floor min shape_quality() of the tets that coarsen() and refine() leave.
  void coarsen(double size, float floor);
  void refine(double size, float floor);
  /// Improves the bad tets of the region or, after coarsen() or refine(), of the parts that these changed,
  /// including the rim.
  ///
  /// \return number of rounds.
  int improve(const ImprovementPlan& plan);
  /// Number of operations carried out.
  std::uint64_t operations() const { return area_.operations(); }

 private:
  BlockRules rules_;
  ImprovementTools tools_;
  std::vector<Index> region_;
  LocalArea area_;
};

}  // namespace tetwright

#pragma once

#include <vector>

#include "simplify/mesh/local_numbers.h"
#include "simplify/mesh/star_walk.h"
#include "simplify/remesh/change_journal.h"
#include "simplify/schedule/block_runner.h"

namespace tetwright {

/// The rounds of one call of a Remesher, over lists of tets and points that follow what changes; nothing
/// looks at the whole mesh. Of edges only those between points of the region are worked on, or points that
/// came with the call, so that a call does not spread.
class RemeshRounds {
 public:
  struct Bounds {
    float poor;           ///< shape_quality(): tets below it are improved
    float leave_surface;  ///< below this points of surfaces may leave them a little
    float floor;          ///< what coarsening and refining leave
  };
  /// `region`: living tets, each once. `journal` takes down what changes.
  RemeshRounds(const EditableMesh& mesh, BlockRunner& runner, ChangeJournal& journal, const BlockRules& rules,
               const Bounds& bounds, const std::vector<Index>& region);
  ~RemeshRounds();
  RemeshRounds(const RemeshRounds&) = delete;
  RemeshRounds& operator=(const RemeshRounds&) = delete;

  /// Lengths in working coordinates.
  void coarsen(double size);
  void refine(double size);
  void improve();
  /// Operations that were carried out.
  std::uint64_t operations() const { return operations_; }

 private:
  /// The living tets at points, each once, ascending, that have only points of the region.
  std::vector<Index> tets_at(const std::vector<Index>& points);
  std::vector<Index> take_changed_points();
  double mean_edge() const;
  bool in_region(Index point) const { return region_points_.find(point) != no_index; }

  const EditableMesh& mesh_;
  BlockRunner& runner_;
  ChangeJournal& journal_;
  BlockRules rules_;
  Bounds bounds_;
  std::vector<Index> tets_;  ///< to be improved
  LocalNumbers region_points_;
  std::vector<Index> region_point_list_;
  std::vector<Index> changed_points_;  ///< since they were last taken
  StarWalk walk_;
  LocalNumbers seen_;  ///< tets, in tets_at()
  std::uint64_t operations_ = 0;
};

}  // namespace tetwright

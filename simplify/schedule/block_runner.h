// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/progress.h"
#include "simplify/operations/workspace.h"

namespace tetwright {

/// A tet and its four points at the time it was listed: equal points mean that the tet still exists.
struct TetSnapshot {
  Index tet;
  Tet points;
};

/// Runs a block of items (Cutler, Dorsey & McMillan 2004, section 3) in batches of three steps, so that the
/// result is the same for any number of threads (deterministic reservations: Blelloch, Fineman, Gibbons &
/// Shun 2012):
///
/// - decide, in parallel: each item's operation reads the mesh, which nobody changes, and leaves a Proposal;
/// - select, in the batch's order: a proposal wins if no earlier winner's write set meets its read set.
/// Winners commit their volumes to the ledger and get their slots. What lost comes again in the next batch,
/// before the others;
/// - commit, in parallel: winners write their write sets.
///
/// Random numbers come from (seed, block, item). Nothing depends on which thread does what, or when.
class BlockRunner {
 public:
  /// `batch_size`: of the first batch of a block, and the most for all; 0: from the number of items.
  BlockRunner(EditableMesh& mesh, SurfaceGrid& grid, VolumeLedger& ledger, std::uint64_t seed,
              std::size_t batch_size, Progress* progress);
  ~BlockRunner();

  /// An operation or several on an item: done with a proposal, or a refusal. `stage` is 0, or what the
  /// proposal that was committed for this item asked for (Proposal::next_stage).
  using PointAttempt = std::function<Outcome(Workspace&, Index)>;
  using TetAttempt = std::function<Outcome(Workspace&, const TetSnapshot&, int stage)>;
  /// Asked before each winner is chosen; true ends the block.
  using Stop = std::function<bool()>;

  /// In random order: of M items near each other one is in a batch, while a batch slides along the list,
  /// which is in the order of the mesh's curve; so that few meet and memory is near. Throws Interrupted when
  /// cancelled.
  void points(const std::vector<Index>& items, const PointAttempt& attempt, const Stop& stop);
  void tets(const std::vector<TetSnapshot>& items, const TetAttempt& attempt, const Stop& stop);
  /// One try at each of the points with an operation on its star, which may answer anything.
  void each_star(
      const std::vector<Index>& points, Operation kind, const std::function<Outcome(Workspace&)>& operation,
      const Stop& stop = [] { return false; });
  /// In the order given.
  void tets_in_order(const std::vector<TetSnapshot>& items, const TetAttempt& attempt);

  /// Is shown each winner before any of its batch is committed, in their order.
  void set_observer(std::function<void(const Proposal&)> observer) { observer_ = std::move(observer); }

  /// What was counted since the last call.
  struct Totals {
    OperationCounts counts;
    std::uint64_t conflicts = 0;  ///< proposals that lost
    std::uint64_t repeats = 0;    ///< items that were decided again for that reason
    std::uint64_t batches = 0;
    std::vector<std::uint64_t> decided;  ///< items, by worker
  };
  Totals take_totals();

 private:
  struct Entry {
    std::uint32_t item;
    std::int8_t stage;
  };
  struct Worker;
  template <class Item, class Attempt>
  void run(const std::vector<Item>& items, bool in_order, const Attempt& attempt, const Stop& stop);
  /// Decides the entries of batch_ with decide(workspace, entry); fills outcomes_ and proposals_.
  void decide(const std::function<Outcome(Workspace&, const Entry&)>& decide_entry, std::size_t chunk);
  /// Fills winners_ and again_; false if `stop` ended the block.
  bool select(const Stop& stop);
  Outcome admit(Proposal& proposal);
  void commit_winners();
  /// From how many of the batch have lost.
  std::size_t next_batch_size(std::size_t size, std::size_t max_size) const;
  void make_workers();

  EditableMesh& mesh_;
  SurfaceGrid& grid_;
  VolumeLedger& ledger_;
  std::uint64_t seed_;
  std::size_t batch_size_;
  std::uint64_t block_ = 0;
  Progress* progress_;
  std::function<void(const Proposal&)> observer_;

  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<Entry> batch_, again_;
  std::vector<Outcome> outcomes_;                         ///< of batch_
  std::vector<Proposal> proposals_;                       ///< of those whose outcome is done
  std::vector<std::uint32_t> winners_, surface_winners_;  ///< places in batch_
  std::size_t lost_ = 0;                                  ///< of the batch
  Totals totals_;
};

/// Whether a listed tet is still there.
inline bool exists(const EditableMesh& mesh, const TetSnapshot& item) {
  return mesh.points(item.tet) == item.points;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "simplify/operations/workspace.h"
#include "tetwright/progress.h"

namespace tetwright {

/// A tet and its four points when it was listed: if they are still equal, the tet still exists.
struct TetSnapshot {
  Index tet;
  Tet points;
};

/// Runs a block of items (Cutler, Dorsey & McMillan 2004, section 3) in batches of three steps. The result is
/// the same for any number of threads (deterministic reservations: Blelloch, Fineman, Gibbons & Shun 2012):
///
/// - decide, in parallel: each item's operation reads the mesh, which does not change, and leaves a Proposal;
/// - select, in the batch's order: a proposal wins if no earlier winner's write set intersects its read set.
///   Winners commit their volumes to the ledger and get their slots. Losers are decided again in the next
///   batch, before all other items;
/// - commit, in parallel: winners write their write sets.
///
/// Random numbers are seeded by (seed, block, item). Results do not depend on the assignment of work to
/// threads or on timing.
class BlockRunner {
 public:
  /// \param batch_size size of a block's first batch, and max size of all; 0: chosen from the number of
  ///   items.
  /// \param progress may be null.
  BlockRunner(EditableMesh& mesh, SurfaceGrid& grid, VolumeLedger& ledger, std::uint64_t seed,
              std::size_t batch_size, Progress* progress);
  ~BlockRunner();

  /// Tries one or more operations on an item: returns done with a proposal, or a refusal. `stage` is 0, or
  /// the Proposal::next_stage of the proposal committed for this item.
  using PointAttempt = std::function<Outcome(Workspace&, Index)>;
  using TetAttempt = std::function<Outcome(Workspace&, const TetSnapshot&, int stage)>;
  /// Called before each winner is selected; true ends the block.
  using Stop = std::function<bool()>;

  /// Runs the items in random order, with one of M neighbouring items in a batch, so that few conflict.
  /// Batches advance along the list, for memory locality.
  ///
  /// \param items in the order of the mesh's space-filling curve.
  /// \throws Interrupted or OutOfTime between batches.
  void points(const std::vector<Index>& items, const PointAttempt& attempt, const Stop& stop);
  void tets(const std::vector<TetSnapshot>& items, const TetAttempt& attempt, const Stop& stop);
  /// Tries an operation once on the star of each point. `operation` may return any outcome.
  ///
  /// \param kind the operation under which it is counted.
  void each_star(
      const std::vector<Index>& points, Operation kind, const std::function<Outcome(Workspace&)>& operation,
      const Stop& stop = [] { return false; });
  /// Runs the items in the given order.
  void tets_in_order(const std::vector<TetSnapshot>& items, const TetAttempt& attempt);

  /// Calls `observer` with each winner, in their order, before any of the batch is committed.
  void set_observer(std::function<void(const Proposal&)> observer) { observer_ = std::move(observer); }

  /// Totals since the last call.
  struct Totals {
    OperationCounts counts;
    std::uint64_t conflicts = 0;  ///< proposals that lost
    std::uint64_t repeats = 0;    ///< items decided again for that reason
    std::uint64_t batches = 0;
    std::vector<std::uint64_t> decided;  ///< decided items by worker
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
  /// Decides the entries of batch_; fills outcomes_ and proposals_.
  void decide(const std::function<Outcome(Workspace&, const Entry&)>& decide_entry, bool in_order);
  /// Fills winners_ and again_; false if `stop` ended the block.
  bool select(const Stop& stop);
  Outcome admit(Proposal& proposal);
  void commit_winners();
  /// Adapts the batch size to the number of losers.
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
  std::vector<Proposal> proposals_;                       ///< by batch entry, if its outcome is done
  std::vector<std::uint32_t> winners_, surface_winners_;  ///< indices into batch_
  std::size_t lost_ = 0;                                  ///< of the batch
  Totals totals_;
};

/// Whether a listed tet still exists.
inline bool exists(const EditableMesh& mesh, const TetSnapshot& item) {
  return mesh.points(item.tet) == item.points;
}

}  // namespace tetwright

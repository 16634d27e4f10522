#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/progress.h"
#include "simplify/operations/workspace.h"

namespace tetwright {

/// A tet and its four points at the time it was listed. A worker locks these points and compares: equal means
/// that the tet still exists.
struct ListedTet {
  Index tet;
  Tet points;
};

/// Runs a block of items as tasks (Cutler, Dorsey & McMillan 2004, section 3, made parallel). The items come
/// in the order of the mesh's curve, are cut into chunks of fixed size, and shuffled within and between the
/// chunks, so that the order is random and memory near. Each chunk has its own random stream, from (seed,
/// block, chunk).
class BlockRunner {
 public:
  BlockRunner(EditableMesh& mesh, SurfaceGrid& grid, VolumeLedger& ledger, std::uint64_t seed,
              std::size_t chunk_size, Progress* progress)
      : mesh_(mesh),
        grid_(grid),
        ledger_(ledger),
        seed_(seed),
        chunk_size_(chunk_size),
        progress_(progress) {}

  /// New workspaces for thread_count() workers; to be called after every EditableMesh::compact, which takes
  /// back the slots that the old ones hoarded.
  void reset_workspaces();

  /// Calls `attempt` with a workspace that has no locks and one item; all locks that it takes are released
  /// afterwards. Items that answer lock_taken are retried after the rest of the chunk, at most eight times,
  /// then counted as skipped. `stop` is called before each item; true ends the block. Throws Interrupted when
  /// cancelled.
  void points(const std::vector<Index>& items, const std::function<Outcome(Workspace&, Index)>& attempt,
              const std::function<bool()>& stop);
  void tets(const std::vector<ListedTet>& items,
            const std::function<Outcome(Workspace&, const ListedTet&)>& attempt,
            const std::function<bool()>& stop);

  /// The same in the order given, without shuffling, in small chunks: what comes first is begun first.
  void tets_in_order(const std::vector<ListedTet>& items,
                     const std::function<Outcome(Workspace&, const ListedTet&)>& attempt);

  /// What the tasks counted since the last call.
  struct Totals {
    OperationCounts counts;
    std::uint64_t lock_conflicts = 0;
    std::uint64_t skipped = 0;
  };
  Totals take_totals();

 private:
  template <class Item, class Attempt>
  void run(const std::vector<Item>& items, std::size_t chunk_size, bool shuffled, const Attempt& attempt,
           const std::function<bool()>& stop);

  EditableMesh& mesh_;
  SurfaceGrid& grid_;
  VolumeLedger& ledger_;
  std::uint64_t seed_;
  std::size_t chunk_size_;
  std::uint64_t block_ = 0;
  Progress* progress_;
  std::vector<std::unique_ptr<Workspace>> workspaces_;
};

/// Locks the item's four points and compares: done, lock_taken, or stale.
Outcome validate(Workspace& ws, const ListedTet& item);

}  // namespace tetwright

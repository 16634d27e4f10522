#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/progress.h"
#include "simplify/task.h"

namespace tetwright {

/// A listed tet with its points as they were: while no task runs both are read, and a task later compares.
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

  /// Fresh tasks for thread_count() workers; to be called after every EditableMesh::compact, which takes back
  /// the slots that the old ones hoarded.
  void reset_tasks();

  /// `attempt` gets a task that holds nothing and one item; what it locks is released after it. lock_taken:
  /// it is tried again after the chunk's other items, eight times at most, then counted as skipped. `stop` is
  /// asked before each item. Throws Interrupted when cancelled.
  void points(const std::vector<Index>& items, const std::function<Outcome(Task&, Index)>& attempt,
              const std::function<bool()>& stop);
  void tets(const std::vector<ListedTet>& items,
            const std::function<Outcome(Task&, const ListedTet&)>& attempt,
            const std::function<bool()>& stop);

  /// The same in the order given, without shuffling, in small chunks: what comes first is begun first.
  void tets_in_order(const std::vector<ListedTet>& items,
                     const std::function<Outcome(Task&, const ListedTet&)>& attempt);

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
  std::vector<std::unique_ptr<Task>> tasks_;
};

/// Locks the item's four points and compares: done, lock_taken, or stale.
Outcome hold(Task& task, const ListedTet& item);

}  // namespace tetwright

#include "simplify/schedule/block_runner.h"

#include <numeric>

#include "common/parallel/parallel.h"

namespace tetwright {

namespace {

/// How often an item that met a taken lock is tried again before it is counted as skipped.
constexpr int max_retries = 8;

/// Items of a chunk of an ordered block: few, so that all workers stay near the front of the list.
constexpr std::size_t ordered_chunk = 64;

/// Gives all locks back, also when an attempt throws.
struct ReleaseAtEnd {
  Workspace& ws;
  ~ReleaseAtEnd() { ws.release(); }
};

}  // namespace

void BlockRunner::reset_workspaces() {
  workspaces_.clear();
  for (unsigned i = 0; i < thread_count(); ++i)
    workspaces_.push_back(std::make_unique<Workspace>(mesh_, grid_, ledger_));
}

template <class Item, class Attempt>
void BlockRunner::run(const std::vector<Item>& items, std::size_t chunk_size, bool shuffled,
                      const Attempt& attempt, const std::function<bool()>& stop) {
  const std::uint64_t block = block_++;
  const std::size_t chunks = (items.size() + chunk_size - 1) / chunk_size;
  std::vector<std::uint32_t> order(chunks);
  std::iota(order.begin(), order.end(), 0u);
  if (shuffled) Random(seed_, block, ~std::uint64_t{0}).shuffle(std::span(order));
  parallel_chunks(chunks, [&](std::size_t k, unsigned worker) {
    const std::uint32_t chunk = order[k];
    Workspace& ws = *workspaces_[worker];
    ws.random = Random(seed_, block, chunk);
    const std::size_t begin = chunk * chunk_size, end = std::min(items.size(), begin + chunk_size);
    std::vector<Item> left(items.begin() + static_cast<std::ptrdiff_t>(begin),
                           items.begin() + static_cast<std::ptrdiff_t>(end));
    if (shuffled) ws.random.shuffle(std::span(left));
    for (int round = 0; !left.empty(); ++round) {
      std::size_t again = 0;
      for (const Item& item : left) {
        if (stop() || (progress_ && progress_->cancelled())) return;
        const Outcome o = [&] {
          const ReleaseAtEnd release{ws};
          return attempt(ws, item);
        }();
        if (o != Outcome::lock_taken) continue;
        ++ws.lock_conflicts;
        left[again++] = item;  // `again` never overtakes the item being read
      }
      left.resize(again);
      if (round == max_retries) {
        ws.skipped += left.size();
        return;
      }
    }
  });
  if (progress_) progress_->throw_if_cancelled();
}

void BlockRunner::points(const std::vector<Index>& items,
                         const std::function<Outcome(Workspace&, Index)>& attempt,
                         const std::function<bool()>& stop) {
  run(items, chunk_size_, true, attempt, stop);
}

void BlockRunner::tets(const std::vector<ListedTet>& items,
                       const std::function<Outcome(Workspace&, const ListedTet&)>& attempt,
                       const std::function<bool()>& stop) {
  run(items, chunk_size_, true, attempt, stop);
}

void BlockRunner::tets_in_order(const std::vector<ListedTet>& items,
                                const std::function<Outcome(Workspace&, const ListedTet&)>& attempt) {
  run(items, std::min(chunk_size_, ordered_chunk), false, attempt, [] { return false; });
}

BlockRunner::Totals BlockRunner::take_totals() {
  Totals totals;
  for (const auto& ws : workspaces_) {
    totals.counts.add(ws->counts);
    totals.lock_conflicts += ws->lock_conflicts;
    totals.skipped += ws->skipped;
    ws->counts = {};
    ws->lock_conflicts = 0;
    ws->skipped = 0;
  }
  return totals;
}

Outcome validate(Workspace& ws, const ListedTet& item) {
  for (Index p : item.points)
    if (!ws.points.try_lock(p)) return Outcome::lock_taken;
  // Only now do the ids mean anything: equal, and all four points of the tet are held, so it stays as it is.
  return ws.mesh.load_points(item.tet) == item.points ? Outcome::done : Outcome::stale;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/block_runner.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <type_traits>

#ifdef TETWRIGHT_INJECT_YIELDS
#include <thread>
#endif

#include "simplify/tuning/tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Batches = SimplifyTuning::Batches;

/// The order of a shuffled block, by ascending keys. Item i has the key i / step + r, where the r of
/// `spacing` consecutive items are a random permutation of the numbers below `spacing`. `step` 0: the given
/// order.
class BlockOrder {
 public:
  BlockOrder(std::size_t items, std::size_t step, std::size_t spacing, Random random)
      : items_(items), step_(step), spacing_(spacing), left_(items), random_(random) {
    if (step_ == 0) return;
    keys_.resize(spacing_);
    std::iota(keys_.begin(), keys_.end(), 0u);
    waiting_.resize(spacing_);
  }
  bool empty() const { return left_ == 0; }
  /// \pre !empty().
  std::uint32_t take() {
    --left_;
    if (step_ == 0) return static_cast<std::uint32_t>(listed_++);
    while (next_ == due_.size()) list_next_key();
    return due_[next_++];
  }

 private:
  void list_next_key() {
    for (const std::size_t end = std::min(items_, listed_ + step_); listed_ < end; ++listed_) {
      const std::size_t place = listed_ % spacing_;
      if (place == 0) random_.shuffle(std::span<std::uint32_t>(keys_));
      waiting_[(key_ + keys_[place]) % spacing_].push_back(static_cast<std::uint32_t>(listed_));
    }
    due_.clear();
    next_ = 0;
    std::swap(due_, waiting_[key_++ % spacing_]);
  }

  std::size_t items_, step_, spacing_, left_, listed_ = 0, key_ = 0;
  Random random_;
  std::vector<std::uint32_t> keys_;  ///< of `spacing` consecutive items, less key_
  std::vector<std::vector<std::uint32_t>> waiting_;
  std::vector<std::uint32_t> due_;  ///< items of one key
  std::size_t next_ = 0;            ///< of due_
};

/// Occasionally lets another thread run, in the test build that looks for dependence on timing.
void maybe_yield() {
#ifdef TETWRIGHT_INJECT_YIELDS
  static thread_local Random random(reinterpret_cast<std::uintptr_t>(&random));
  if (random.below(4) == 0) std::this_thread::sleep_for(std::chrono::microseconds(random.below(50)));
#endif
}

/// Runs chunks in parallel, or in this thread if there are fewer than `min_parallel` items.
void for_chunks(std::size_t count, std::size_t chunk, std::size_t min_parallel,
                const std::function<void(std::size_t begin, std::size_t end, unsigned worker)>& body) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  if (count < min_parallel) {
    body(0, count, 0);
    return;
  }
  parallel_chunks(chunks, [&](std::size_t k, unsigned worker) {
    body(k * chunk, std::min(count, (k + 1) * chunk), worker);
  });
}

}  // namespace

struct BlockRunner::Worker {
  Worker(const EditableMesh& mesh, const SurfaceGrid& grid, const VolumeLedger& ledger)
      : workspace(mesh, grid, ledger) {}
  Workspace workspace;
  CommitWorkspace commit_workspace;
  std::uint64_t decided = 0;
};

BlockRunner::BlockRunner(EditableMesh& mesh, SurfaceGrid& grid, VolumeLedger& ledger, std::uint64_t seed,
                         std::size_t batch_size, Progress* progress)
    : mesh_(mesh), grid_(grid), ledger_(ledger), seed_(seed), batch_size_(batch_size), progress_(progress) {}

BlockRunner::~BlockRunner() = default;

void BlockRunner::make_workers() {
  while (workers_.size() < thread_count())
    workers_.push_back(std::make_unique<Worker>(mesh_, grid_, ledger_));
}

void BlockRunner::decide(const std::function<Outcome(Workspace&, const Entry&)>& decide_entry,
                         bool in_order) {
  outcomes_.assign(batch_.size(), Outcome::stale);
  if (proposals_.size() < batch_.size()) proposals_.resize(batch_.size());
  const std::size_t chunk = in_order ? Batches::chunk_in_order : Batches::chunk_shuffled,
                    min_parallel = in_order ? Batches::min_parallel_in_order : Batches::min_parallel_shuffled;
  for_chunks(batch_.size(), chunk, min_parallel, [&](std::size_t begin, std::size_t end, unsigned worker) {
    const WriteRule::Deciding rule;
    Workspace& ws = workers_[worker]->workspace;
    workers_[worker]->decided += end - begin;
    for (std::size_t i = begin; i < end; ++i) {
      maybe_yield();
      ws.proposal.clear();
      outcomes_[i] = decide_entry(ws, batch_[i]);
      if (outcomes_[i] == Outcome::done) std::swap(ws.proposal, proposals_[i]);
    }
  });
}

Outcome BlockRunner::admit(Proposal& p) {
  if (!mesh_.reservations().free(p.read_set())) return Outcome::conflict;
  if (!p.edit.empty())
    for (std::uint32_t w : surface_winners_)
      if (!SurfaceGrid::apart(proposals_[w].edit, p.edit)) return Outcome::conflict;
  if (!ledger_.allows(p.volumes)) return Outcome::volume;
  if (!p.count_bounds.allow(mesh_.live_tets(), p.count_change)) return Outcome::count;
  ledger_.commit(p.volumes);
  grant(mesh_, grid_, p);
  return Outcome::done;
}

bool BlockRunner::select(const Stop& stop) {
  winners_.clear();
  surface_winners_.clear();
  again_.clear();
  lost_ = 0;
  std::size_t tets = 0, points = 0;
  for (std::size_t i = 0; i < batch_.size(); ++i) {
    if (outcomes_[i] != Outcome::done || proposals_[i].change != Proposal::Change::replace) continue;
    const Proposal& p = proposals_[i];
    if (p.added.size() > p.removed.size()) tets += p.added.size() - p.removed.size();
    points += p.has_new_point;
  }
  begin_batch(mesh_, batch_.size(), tets, points);
  for (std::uint32_t i = 0; i < batch_.size(); ++i) {
    if (outcomes_[i] != Outcome::done) continue;
    if (stop()) return false;
    Proposal& p = proposals_[i];
    const Outcome o = admit(p);
    if (o == Outcome::conflict) {
      ++lost_;
      again_.push_back(batch_[i]);
    }
    totals_.counts.add(p.operation, o);
    if (o != Outcome::done) continue;
    if (observer_) observer_(p);
    winners_.push_back(i);
    if (!p.edit.empty()) surface_winners_.push_back(i);
    if (p.next_stage >= 0) again_.push_back({batch_[i].item, static_cast<std::int8_t>(p.next_stage)});
  }
  return true;
}

void BlockRunner::commit_winners() {
  for_chunks(winners_.size(), Batches::commit_chunk, Batches::min_parallel_shuffled,
             [&](std::size_t begin, std::size_t end, unsigned worker) {
               for (std::size_t i = begin; i < end; ++i) {
                 maybe_yield();
                 commit(mesh_, grid_, proposals_[winners_[i]], workers_[worker]->commit_workspace);
               }
             });
  end_batch(mesh_, grid_);
}

std::size_t BlockRunner::next_batch_size(std::size_t size, std::size_t max_size) const {
  const auto lost = static_cast<double>(lost_);
  const double max_lost = Batches::max_lost_share * static_cast<double>(lost_ + winners_.size());
  if (lost > max_lost) return std::max(std::min(Batches::min_shrunk_size, max_size), size - size / 4);
  return lost < max_lost / 2 ? std::min(max_size, size + size / 4) : size;
}

template <class Item, class Attempt>
void BlockRunner::run(const std::vector<Item>& items, bool in_order, const Attempt& attempt,
                      const Stop& stop) {
  make_workers();
  const std::uint64_t block = block_++;
  const std::size_t n = items.size();
  std::size_t step = batch_size_;
  if (step == 0)
    step = in_order ? std::clamp(n / Batches::ordered_batches, Batches::min_ordered_size,
                                 Batches::max_ordered_size)
                    : std::clamp(n / Batches::batches_of_large_blocks, Batches::min_size, Batches::max_size);
  constexpr std::size_t spacing =
      std::is_same_v<Item, TetSnapshot> ? Batches::tet_spacing : Batches::point_spacing;
  BlockOrder order(n, in_order ? 0 : step, spacing, Random(seed_, block, ~std::uint64_t{0}));
  const auto decide_entry = [&](Workspace& ws, const Entry& entry) {
    ws.random = Random(seed_, block, entry.item);
    return attempt(ws, items[entry.item], static_cast<int>(entry.stage));
  };
  std::size_t batch = step;
  again_.clear();
  while (!order.empty() || !again_.empty()) {
    if (progress_) progress_->throw_if_stopped();
    // Process losers first, so that each item is eventually decided.
    totals_.repeats += static_cast<std::uint64_t>(
        std::count_if(again_.begin(), again_.end(), [](const Entry& e) { return e.stage == 0; }));
    batch_ = again_;
    while (batch_.size() < batch && !order.empty()) batch_.push_back({order.take(), 0});
    ++totals_.batches;
    decide(decide_entry, in_order);
    const bool goes_on = select(stop);
    totals_.conflicts += lost_;
    commit_winners();
    if (!goes_on) return;
    batch = next_batch_size(batch, step);
  }
}

void BlockRunner::points(const std::vector<Index>& items, const PointAttempt& attempt, const Stop& stop) {
  run(
      items, false, [&](Workspace& ws, Index p, int) { return attempt(ws, p); }, stop);
}

void BlockRunner::tets(const std::vector<TetSnapshot>& items, const TetAttempt& attempt, const Stop& stop) {
  run(items, false, attempt, stop);
}

void BlockRunner::each_star(const std::vector<Index>& points, Operation kind,
                            const std::function<Outcome(Workspace&)>& operation, const Stop& stop) {
  this->points(
      points,
      [&](Workspace& ws, Index p) {
        Outcome o = ws.gather(p);
        if (o == Outcome::done) o = operation(ws);
        return ws.count(kind, o);
      },
      stop);
}

void BlockRunner::tets_in_order(const std::vector<TetSnapshot>& items, const TetAttempt& attempt) {
  run(items, true, attempt, [] { return false; });
}

BlockRunner::Totals BlockRunner::take_totals() {
  Totals totals = std::move(totals_);
  totals_ = {};
  totals.decided.assign(workers_.size(), 0);
  for (std::size_t w = 0; w < workers_.size(); ++w) {
    totals.counts.add(workers_[w]->workspace.counts);
    workers_[w]->workspace.counts = {};
    totals.decided[w] = std::exchange(workers_[w]->decided, 0);
  }
  return totals;
}

}  // namespace tetwright

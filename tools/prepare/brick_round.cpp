// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/brick_round.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Makes bricks, `workers` of them at the same time.
/// \param keep is called by one thread at a time
template <class Make, class Keep>
void make_alone(const std::vector<BrickTask>& tasks, unsigned workers, const Make& make, const Keep& keep) {
  if (workers == 1) {
    for (const BrickTask& task : tasks) keep(task.brick, make(task));
    return;
  }
  const ThreadLimit limit(workers);
  std::mutex mutex;
  parallel_chunks(tasks.size(), [&](std::size_t i, unsigned) {
    const ThreadLimit one(1);
    BrickPart part = make(tasks[i]);
    const std::lock_guard guard(mutex);
    keep(tasks[i].brick, std::move(part));
  });
}

}  // namespace

BrickRound::BrickRound(BrickStore& store, std::vector<std::size_t> work, unsigned workers, BrickTeam* team,
                       BrickTeam::Make make, Progress& progress)
    : store_(store),
      work_(std::move(work)),
      workers_(workers),
      team_(team),
      make_(std::move(make)),
      progress_(progress),
      borders_(store.count()),
      kept_(store.count(), 0) {}

void BrickRound::make(const std::vector<BrickTask>& tasks) {
  std::vector<BrickTask> left;
  for (const BrickTask& task : tasks)
    if (std::optional<BrickBorder> border = store_.finished(task))
      borders_[task.brick] = std::move(*border);
    else
      left.emplace_back(task).thin = thin_;
  // Largest first: nobody waits long for the last one.
  std::stable_sort(left.begin(), left.end(),
                   [&](const BrickTask& a, const BrickTask& b) { return work_[a.brick] > work_[b.brick]; });
  std::size_t done = tasks.size() - left.size();
  const auto show = [&, caller = std::this_thread::get_id()] {
    if (std::this_thread::get_id() == caller)
      progress_.update(static_cast<double>(done) / static_cast<double>(tasks.size()));
  };
  show();
  const auto keep = [&](std::size_t brick, auto part) {
    borders_[brick] = store_.keep(brick, std::move(part));
    ++done;
    show();
  };
  if (team_)
    team_->lead(left, make_, keep);
  else
    make_alone(left, workers_, make_, keep);
}

void BrickRound::make_all() {
  std::vector<BrickTask> tasks(store_.count());
  for (std::size_t b = 0; b < tasks.size(); ++b) tasks[b].brick = b;
  make(tasks);
}

std::size_t BrickRound::separate(const std::function<std::vector<std::size_t>()>& meeting) {
  std::size_t again = 0;
  for (std::vector<std::size_t> bricks = meeting(); !bricks.empty(); bricks = meeting()) {
    std::vector<BrickTask> tasks;
    for (const std::size_t b : bricks)
      if (b < kept_.size() && !std::exchange(kept_[b], 1)) tasks.push_back({b, borders_[b].halo, true});
    // Surfaces that were not moved do not meet.
    TETWRIGHT_CHECK(!tasks.empty());
    again += tasks.size();
    make(tasks);
  }
  return again;
}

}  // namespace tetwright

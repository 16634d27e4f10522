// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/brick_round.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "tetwright/error.h"
#include "tetwright/resources.h"
#include "tools/bricks/brick_bytes.h"

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

BrickRound::BrickRound(BrickStore& store, std::vector<std::size_t> work, BrickMaking making,
                       BrickReport& report, Progress& progress)
    : store_(store),
      work_(std::move(work)),
      making_(std::move(making)),
      report_(report),
      progress_(progress),
      borders_(store.count()),
      kept_(store.count(), 0) {
  if (making_.team) report_.by_helpers.resize(static_cast<std::size_t>(store.round()), 0);
}

void BrickRound::make(const std::vector<BrickTask>& tasks) {
  std::vector<BrickTask> left;
  for (BrickTask task : tasks) {
    task.round = store_.round();
    task.thin = thin_;
    if (std::optional<BrickBorder> border = store_.finished(task))
      borders_[task.brick] = std::move(*border);
    else
      left.push_back(task);
  }
  // Largest first: nobody waits long for the last one.
  std::stable_sort(left.begin(), left.end(),
                   [&](const BrickTask& a, const BrickTask& b) { return work_[a.brick] > work_[b.brick]; });
  std::size_t done = tasks.size() - left.size();
  const auto show = [&, caller = std::this_thread::get_id()] {
    if (std::this_thread::get_id() == caller)
      progress_.update(static_cast<double>(done) / static_cast<double>(tasks.size()));
  };
  show();
  const auto keep = [&]<class Part>(std::size_t brick, Part&& part) {
    borders_[brick] = store_.keep(brick, std::forward<Part>(part));
    ++done;
    show();
  };
  if (!making_.team) {
    make_alone(left, making_.workers, making_.make, keep);
    return;
  }
  std::mutex mutex;
  const auto keep_one = [&]<class Part>(std::size_t task, Part&& part) {
    const std::lock_guard guard(mutex);
    keep(left[task].brick, std::forward<Part>(part));
  };
  report_.by_helpers.back() +=
      making_.team->lead({left.size(), [&](std::size_t task) { keep_one(task, making_.make(left[task])); },
                          [&](std::size_t task) {
                            return to_bytes(BrickRequest{left[task], making_.pieces(left[task])});
                          },
                          [&](std::size_t task, const std::string& bytes) { keep_one(task, bytes); }});
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

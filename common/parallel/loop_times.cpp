// SPDX-License-Identifier: Apache-2.0
#include "tetwright/loop_times.h"

#include <ctime>
#include <utility>

#include "common/parallel/counted_loop.h"

namespace tetwright {

namespace {

/// The innermost CountLoops; null without one and while a loop is counted.
thread_local CountLoops* innermost_count = nullptr;

double thread_seconds_now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

void LoopTimes::add(double loop_seconds, std::size_t parts) {
  seconds += loop_seconds;
  ++loops;
  for (std::size_t i = 0; i < cores.size(); ++i) {
    const std::size_t of_busiest = parts / cores[i] + (parts % cores[i] != 0);
    on_cores[i] += loop_seconds * (static_cast<double>(of_busiest) / static_cast<double>(parts));
  }
}

LoopTimes& LoopTimes::operator+=(const LoopTimes& other) {
  thread_seconds += other.thread_seconds;
  seconds += other.seconds;
  loops += other.loops;
  for (std::size_t i = 0; i < cores.size(); ++i) on_cores[i] += other.on_cores[i];
  return *this;
}

LoopTimes operator-(LoopTimes later, const LoopTimes& earlier) {
  later.thread_seconds -= earlier.thread_seconds;
  later.seconds -= earlier.seconds;
  later.loops -= earlier.loops;
  for (std::size_t i = 0; i < LoopTimes::cores.size(); ++i) later.on_cores[i] -= earlier.on_cores[i];
  return later;
}

CountLoops::CountLoops()
    : thread_start_(thread_seconds_now()), before_(std::exchange(innermost_count, this)) {}

CountLoops::~CountLoops() {
  innermost_count = before_;
  if (before_) before_->times_ += times_;
}

LoopTimes loop_times() {
  if (!innermost_count) return {};
  LoopTimes times = innermost_count->times_;
  times.thread_seconds = thread_seconds_now() - innermost_count->thread_start_;
  return times;
}

CountedLoop::CountedLoop(std::size_t parts) : count_(nullptr), parts_(parts) {
  if (!innermost_count || parts < 2) return;
  count_ = std::exchange(innermost_count, nullptr);
  start_ = thread_seconds_now();
}

CountedLoop::~CountedLoop() {
  if (!count_) return;
  count_->times_.add(thread_seconds_now() - start_, parts_);
  innermost_count = count_;
}

}  // namespace tetwright

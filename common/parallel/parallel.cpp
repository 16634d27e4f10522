// SPDX-License-Identifier: Apache-2.0
#include "tetwright/resources.h"

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include "common/parallel/counted_loop.h"
#include "common/parallel/host_threads.h"
#include "common/parallel/tbb_loop.h"

namespace tetwright {

namespace {

/// Maximum number of threads of parallel work started by this thread; 0 without a ThreadLimit. Loops pass it
/// on to the threads that run their bodies.
thread_local unsigned thread_limit = 0;

/// Sets thread_limit during its lifetime.
class LimitHere {
 public:
  explicit LimitHere(unsigned limit) : before_(std::exchange(thread_limit, limit)) {}
  ~LimitHere() { thread_limit = before_; }
  LimitHere(const LimitHere&) = delete;
  LimitHere& operator=(const LimitHere&) = delete;

 private:
  unsigned before_;
};

/// The thread sanitizer cannot see how TBB synchronises its threads, since the library is not instrumented.
/// These two atomics express TBB's guarantees: everything before a loop happens before each body, and each
/// body happens before everything after the loop. They are separate, and no body acquires at its end, so that
/// no order among bodies is claimed. They are global, since a body must not read data of its caller before it
/// has acquired.
std::atomic<unsigned> loop_started{0};
std::atomic<unsigned> body_ended{0};

/// Releases at the end of a body, even if it throws.
struct BodyEnd {
  ~BodyEnd() { body_ended.fetch_add(1, std::memory_order_release); }
};
/// Acquires in the caller at the end of the loop, even if it throws.
struct LoopEnd {
  ~LoopEnd() { (void)body_ended.load(std::memory_order_acquire); }
};

/// Calls body(i) for each i in [0, count), on at most thread_count() threads.
void run_loop(std::size_t count, const std::function<void(std::size_t)>& body) {
  struct Loop {
    const std::function<void(std::size_t)>& body;
    unsigned limit;
  };
  const Loop loop{body, thread_count()};
  // Even an idle slot of an arena would wake a thread for every loop.
  const auto threads = static_cast<unsigned>(std::min<std::size_t>(count, loop.limit));
  loop_started.fetch_add(1, std::memory_order_release);
  const LoopEnd loop_end;
  tbb_loop(
      count, threads,
      [](const void* context, std::size_t i) {
        (void)loop_started.load(std::memory_order_acquire);
        const BodyEnd body_end;
        const Loop& of = *static_cast<const Loop*>(context);
        const LimitHere limit(of.limit);
        of.body(i);
      },
      &loop);
}

/// Limits a number of threads to max_threads(); 0: that of the machine.
unsigned sensible_threads(unsigned threads) {
  return threads ? std::min(threads, max_threads()) : hardware_threads();
}

void call_within(const std::function<void()>& work) {
  tbb_within(
      thread_count(), [](const void* context) { (*static_cast<const std::function<void()>*>(context))(); },
      &work);
}

}  // namespace

struct ThreadLimit::Impl {
  explicit Impl(unsigned threads) : tbb(threads), here(threads) {}
  TbbThreads tbb;
  LimitHere here;
};

unsigned hardware_threads() { return tbb_concurrency(); }

unsigned max_threads() { return std::max(16u, 4 * hardware_threads()); }

ThreadLimit::ThreadLimit(unsigned threads) { impl_ = std::make_unique<Impl>(sensible_threads(threads)); }

ThreadLimit::~ThreadLimit() = default;

unsigned thread_count() { return thread_limit ? thread_limit : hardware_threads(); }

void with_threads(unsigned threads, const std::function<void()>& work) {
  const ThreadLimit limit(threads);
  call_within(work);
}

void with_threads_of_host(unsigned threads, const std::function<void()>& work) {
  const LimitHere limit(sensible_threads(threads));
  call_within(work);
}

void parallel_for(std::size_t begin, std::size_t end, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  if (begin >= end) return;
  grain = std::max<std::size_t>(1, grain);
  const std::size_t parts = (end - begin + grain - 1) / grain;
  const CountedLoop counted(parts);
  const auto part = [&](std::size_t i) { body(begin + i * grain, std::min(end, begin + (i + 1) * grain)); };
  if (thread_count() == 1 || parts == 1) {
    for (std::size_t i = 0; i < parts; ++i) part(i);
    return;
  }
  run_loop(parts, part);
}

void parallel_chunks(std::size_t chunks, const std::function<void(std::size_t, unsigned)>& body) {
  const unsigned workers = static_cast<unsigned>(std::min<std::size_t>(thread_count(), chunks));
  const CountedLoop counted(chunks);
  if (workers <= 1) {
    for (std::size_t i = 0; i < chunks; ++i) body(i, 0);
    return;
  }
  // Relaxed: the counter only assigns numbers, and the flag only has to become visible eventually.
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  run_loop(workers, [&](std::size_t worker) {
    for (std::size_t i; !failed.load(std::memory_order_relaxed) &&
                        (i = next.fetch_add(1, std::memory_order_relaxed)) < chunks;) {
      try {
        body(i, static_cast<unsigned>(worker));
      } catch (...) {
        failed.store(true, std::memory_order_relaxed);
        throw;
      }
    }
  });
}

double parallel_sum(std::size_t begin, std::size_t end, std::size_t grain,
                    const std::function<double(std::size_t, std::size_t)>& body) {
  if (begin >= end) return 0;
  std::vector<double> parts((end - begin + grain - 1) / grain);
  parallel_for(0, parts.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      parts[k] = body(begin + k * grain, std::min(end, begin + (k + 1) * grain));
  });
  double sum = 0;
  for (double part : parts) sum += part;
  return sum;
}

}  // namespace tetwright

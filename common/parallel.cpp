#include "common/parallel.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <vector>

namespace tetwright {

namespace {

/// Threads that parallel work may use; 0 until a ThreadLimit says otherwise.
std::atomic<unsigned> thread_limit{0};

/// TBB's own hand-over between threads is invisible to the thread sanitizer when the library is not
/// instrumented. Two atomics state what it guarantees: all before the loop happens before each body, each
/// body before all after the loop. Two, and not acquired at a body's end, so that no order among the bodies
/// is claimed that does not exist.
class HandOver {
 public:
  HandOver() { start_.fetch_add(1, std::memory_order_release); }
  void body_begins() const { (void)start_.load(std::memory_order_acquire); }
  void body_ends() { done_.fetch_add(1, std::memory_order_release); }
  void join() const { (void)done_.load(std::memory_order_acquire); }

 private:
  std::atomic<unsigned> start_{0};
  std::atomic<unsigned> done_{0};
};

}  // namespace

struct ThreadLimit::Impl {
  explicit Impl(unsigned threads) : control(tbb::global_control::max_allowed_parallelism, threads) {}
  tbb::global_control control;
  unsigned before = 0;
};

unsigned hardware_threads() { return static_cast<unsigned>(std::max(1, tbb::info::default_concurrency())); }

ThreadLimit::ThreadLimit(unsigned threads)
    : impl_(std::make_unique<Impl>(threads ? threads : hardware_threads())) {
  impl_->before = thread_limit.exchange(threads ? threads : hardware_threads());
}

ThreadLimit::~ThreadLimit() { thread_limit.store(impl_->before); }

unsigned thread_count() {
  const unsigned limit = thread_limit.load();
  return limit ? limit : hardware_threads();
}

void parallel_for(std::size_t begin, std::size_t end, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  if (begin >= end) return;
  grain = std::max<std::size_t>(1, grain);
  if (thread_count() == 1 || end - begin <= grain) {
    for (std::size_t i = begin; i < end; i += grain) body(i, std::min(end, i + grain));
    return;
  }
  HandOver hand_over;
  tbb::task_arena arena(static_cast<int>(thread_count()));
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, grain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        hand_over.body_begins();
                        body(range.begin(), range.end());
                        hand_over.body_ends();
                      });
  });
  hand_over.join();
}

void parallel_chunks(std::size_t chunks, const std::function<void(std::size_t, unsigned)>& body) {
  const unsigned workers = static_cast<unsigned>(std::min<std::size_t>(thread_count(), chunks));
  if (workers <= 1) {
    for (std::size_t i = 0; i < chunks; ++i) body(i, 0);
    return;
  }
  // Relaxed: the counter only hands out numbers.
  std::atomic<std::size_t> next{0};
  HandOver hand_over;
  tbb::task_arena arena(static_cast<int>(workers));
  arena.execute([&] {
    tbb::parallel_for(
        0u, workers,
        [&](unsigned worker) {
          hand_over.body_begins();
          for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < chunks;) body(i, worker);
          hand_over.body_ends();
        },
        tbb::simple_partitioner());
  });
  hand_over.join();
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

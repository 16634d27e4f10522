#include "common/parallel.h"

#include <algorithm>
#include <atomic>
#include <vector>

#include "common/tbb_loop.h"

namespace tetwright {

namespace {

/// Threads that parallel work may use; 0 until a ThreadLimit says otherwise.
std::atomic<unsigned> thread_limit{0};

/// TBB's own hand-over between threads is invisible to the thread sanitizer, since the library is not
/// instrumented. Two atomics state what it guarantees: all before a loop happens before each body, each body
/// before all after the loop. Two, and none acquired at a body's end, so that no order among the bodies is
/// claimed that does not exist. Global, so that a body reads nothing of its caller's before it has acquired.
std::atomic<unsigned> loop_started{0};
std::atomic<unsigned> body_ended{0};

/// Says so when a body ends, also by an exception.
struct BodyEnd {
  ~BodyEnd() { body_ended.fetch_add(1, std::memory_order_release); }
};
/// The caller's side of it, also when an exception comes through.
struct LoopEnd {
  ~LoopEnd() { (void)body_ended.load(std::memory_order_acquire); }
};

/// body(i) for each i in [0, count) on up to `threads` threads.
void run_loop(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& body) {
  loop_started.fetch_add(1, std::memory_order_release);
  const LoopEnd loop_end;
  tbb_loop(
      count, threads,
      [](const void* context, std::size_t i) {
        (void)loop_started.load(std::memory_order_acquire);
        const BodyEnd body_end;
        (*static_cast<const std::function<void(std::size_t)>*>(context))(i);
      },
      &body);
}

}  // namespace

struct ThreadLimit::Impl {
  explicit Impl(unsigned threads) : tbb(threads) {}
  TbbLimit tbb;
  unsigned before = 0;
};

unsigned hardware_threads() { return tbb_concurrency(); }

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
  const std::size_t parts = (end - begin + grain - 1) / grain;
  const auto part = [&](std::size_t i) { body(begin + i * grain, std::min(end, begin + (i + 1) * grain)); };
  if (thread_count() == 1 || parts == 1) {
    for (std::size_t i = 0; i < parts; ++i) part(i);
    return;
  }
  run_loop(parts, thread_count(), part);
}

void parallel_chunks(std::size_t chunks, const std::function<void(std::size_t, unsigned)>& body) {
  const unsigned workers = static_cast<unsigned>(std::min<std::size_t>(thread_count(), chunks));
  if (workers <= 1) {
    for (std::size_t i = 0; i < chunks; ++i) body(i, 0);
    return;
  }
  // Relaxed: the counter only hands out numbers.
  std::atomic<std::size_t> next{0};
  run_loop(workers, workers, [&](std::size_t worker) {
    for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < chunks;)
      body(i, static_cast<unsigned>(worker));
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

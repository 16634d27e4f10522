#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace tetwright {

/// How many threads the machine offers.
unsigned hardware_threads();

/// While it lives, parallel work uses at most `threads` threads (0: all of the machine; more than the machine
/// has is allowed). One at a time; made and destroyed by the thread that starts the parallel work.
class ThreadLimit {
 public:
  explicit ThreadLimit(unsigned threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The number of threads that parallel work uses now.
unsigned thread_count();

/// Calls `body(begin, end)` for disjoint parts of [begin, end) of about `grain` items, concurrently. What the
/// bodies wrote is visible to the caller afterwards. The first exception ends the loop and is thrown on.
void parallel_for(std::size_t begin, std::size_t end, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body);

/// Calls `body(chunk, worker)` once for each chunk in [0, chunks), by thread_count() workers that each take
/// the next chunk when they have finished one. A worker runs on one thread at a time, so what belongs to a
/// worker needs no lock. With one thread the chunks come in order.
void parallel_chunks(std::size_t chunks, const std::function<void(std::size_t, unsigned)>& body);

/// Sum of `body(begin, end)` over parts of [begin, end) whose bounds depend on `grain` alone and that are
/// added in order, so that the rounding is the same for any number of threads.
double parallel_sum(std::size_t begin, std::size_t end, std::size_t grain,
                    const std::function<double(std::size_t, std::size_t)>& body);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace tetwright {

/// The number of threads that the machine runs at a time.
unsigned hardware_threads();

/// The largest number of threads that parallel work uses: 16, or four for each one that the machine runs at a
/// time if that is more. Threads beyond that wait for each other and make the work slower.
unsigned max_threads();

/// While an object exists, parallel work that the thread which made it starts uses at most `threads` threads,
/// and no more than max_threads(); 0 means hardware_threads(). That of other threads is not affected, nor are
/// loops of other libraries (see with_threads()). Destroyed by the thread that made it, the last one first.
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

/// The largest number of threads that a loop of this thread uses now.
unsigned thread_count();

/// Calls `work` with a ThreadLimit of `threads`, which holds for loops of OpenVDB, too. Several threads may
/// do so at a time, each with its own number. An exception of `work` is rethrown.
void with_threads(unsigned threads, const std::function<void()>& work);

/// Calls `body(begin, end)` for disjoint parts of [begin, end) of `grain` items each (the last may have
/// fewer), concurrently, on no more threads than there are parts. What the bodies wrote is visible to the
/// caller afterwards. The first exception ends the loop and is rethrown.
void parallel_for(std::size_t begin, std::size_t end, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body);

/// Calls `body(chunk, worker)` once for each chunk in [0, chunks), by at most thread_count() workers, each of
/// which takes the next chunk when it has finished one. Workers are numbered from 0. A worker runs on one
/// thread at a time, so that data of a worker needs no lock. With one thread the chunks are taken in order.
/// After an exception no worker takes another chunk; the first exception is rethrown.
void parallel_chunks(std::size_t chunks, const std::function<void(std::size_t, unsigned)>& body);

/// The sum of `body(begin, end)` over parts of [begin, end) whose bounds depend on `grain` alone. The parts
/// are added in order, so that the rounding is the same for any number of threads.
double parallel_sum(std::size_t begin, std::size_t end, std::size_t grain,
                    const std::function<double(std::size_t, std::size_t)>& body);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace tetwright {

/// Number of threads that the machine runs at a time.
unsigned hardware_threads();

/// Maximum number of threads of parallel work: 16, or four for each hardware thread if that is more. Further
/// threads wait for each other and make the work slower.
unsigned max_threads();

/// Limits parallel work started by the constructing thread to `threads` threads, at most max_threads(),
/// during the object's lifetime. Other threads and loops of other libraries are not affected (see
/// with_threads()). Destroy objects on the constructing thread, the last one first.
/// \param threads 0: hardware_threads()
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

/// Maximum number of threads of a loop of this thread now.
unsigned thread_count();

/// Calls `work` under a ThreadLimit of `threads` that also holds for loops of OpenVDB. Several threads may do
/// so at a time, each with its own number. Rethrows an exception of `work`.
void with_threads(unsigned threads, const std::function<void()>& work);

/// Calls `body(begin, end)` for disjoint parts of [begin, end) of `grain` items each (the last may have
/// fewer), concurrently, on no more threads than there are parts. Writes of the bodies are visible to the
/// caller afterwards. The first exception ends the loop and is rethrown.
void parallel_for(std::size_t begin, std::size_t end, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body);

/// Calls `body(chunk, worker)` once for each chunk in [0, chunks), on at most thread_count() workers,
/// numbered from 0, each of which takes the next chunk after finishing one. A worker runs on one thread at a
/// time, so that its data needs no lock. With one thread the chunks run in order. After an exception no
/// worker takes another chunk; the first exception is rethrown.
void parallel_chunks(std::size_t chunks, const std::function<void(std::size_t, unsigned)>& body);

/// Sum of `body(begin, end)` over parts of [begin, end) whose bounds depend on `grain` alone. The parts are
/// added in order, so that rounding is the same for any number of threads.
double parallel_sum(std::size_t begin, std::size_t end, std::size_t grain,
                    const std::function<double(std::size_t, std::size_t)>& body);

}  // namespace tetwright

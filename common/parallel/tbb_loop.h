// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

namespace tetwright {

/// Only the source of this header includes oneTBB; all other code uses parallel.h. The source is compiled
/// without the thread sanitizer: TBB synchronises in a library that is not instrumented, so that the half of
/// it in headers would be reported. parallel.cpp, which is instrumented, states the ordering that TBB
/// guarantees.

/// Number of threads that TBB uses by default, at least 1.
unsigned tbb_concurrency();

/// Raises the number of TBB's threads to `threads` during the object's lifetime, if that is above the
/// default.
class TbbThreads {
 public:
  explicit TbbThreads(unsigned threads);
  ~TbbThreads();
  TbbThreads(const TbbThreads&) = delete;
  TbbThreads& operator=(const TbbThreads&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Calls work(context), whose loops, also of other libraries, use at most `threads` threads. Rethrows.
void tbb_within(unsigned threads, void (*work)(const void* context), const void* context);

/// Calls body(context, i) for each i in [0, count), concurrently on up to `threads` threads. Rethrows the
/// first exception. `body` is a plain pointer, since the uninstrumented source would otherwise read a
/// std::function.
void tbb_loop(std::size_t count, unsigned threads, void (*body)(const void* context, std::size_t i),
              const void* context);

}  // namespace tetwright

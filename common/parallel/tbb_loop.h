// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

namespace tetwright {

/// Only tbb_loop.cpp includes oneTBB; all other code uses tetwright/resources.h. tbb_loop.cpp is compiled
/// without the thread sanitizer: TBB synchronises inside a library that is not instrumented, so the sanitizer
/// would report the part in headers. parallel.cpp, which is instrumented, expresses the ordering that TBB
/// guarantees.

/// Number of threads that TBB uses by default, at least 1.
unsigned tbb_concurrency();

/// Raises the number of TBB's threads to `threads` during the object's lifetime if the default is lower.
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

/// Calls work(context). Loops in it, including those of other libraries, use at most `threads` threads.
/// Rethrows exceptions.
void tbb_within(unsigned threads, void (*work)(const void* context), const void* context);

/// Calls body(context, i) for each i in [0, count), concurrently on up to `threads` threads. Rethrows the
/// first exception. `body` is a function pointer, since the uninstrumented source must not read a
/// std::function.
void tbb_loop(std::size_t count, unsigned threads, void (*body)(const void* context, std::size_t i),
              const void* context);

}  // namespace tetwright

#pragma once

#include <cstddef>
#include <memory>

namespace tetwright {

/// The one door to oneTBB; everything else goes through parallel.h. Its source is compiled without the thread
/// sanitizer: TBB's own synchronisation happens in a library that is not instrumented, so that the half of it
/// that stands in headers would be reported. parallel.cpp, which is instrumented, states the order that TBB
/// guarantees.

/// Threads that TBB would use by itself, at least 1.
unsigned tbb_concurrency();

/// While it lives TBB uses at most that many threads.
class TbbLimit {
 public:
  explicit TbbLimit(unsigned threads);
  ~TbbLimit();
  TbbLimit(const TbbLimit&) = delete;
  TbbLimit& operator=(const TbbLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// body(context, i) for each i in [0, count), concurrently on up to `threads` threads. The first exception is
/// thrown on. A plain pointer, since calling a std::function reads it, in code that may be instrumented.
void tbb_loop(std::size_t count, unsigned threads, void (*body)(const void* context, std::size_t i),
              const void* context);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/parallel/tbb_loop.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <optional>

namespace tetwright {

namespace {

/// Keeps TBB's threads until the process ends, which stops them at any point. Otherwise the last thread would
/// destroy the library's data during exit, and waiting for the threads takes minutes while other programs
/// keep all processors busy.
struct KeptThreads {
  KeptThreads() : handle(tbb::attach{}) {}
  ~KeptThreads() {}  // the handle is never released
  union {
    tbb::task_scheduler_handle handle;
  };
};

/// Call before the first loop.
void keep_threads() { static const KeptThreads kept_threads; }

}  // namespace

// TBB applies the minimum of all such settings: a lower one would limit all threads of the process.
struct TbbThreads::Impl {
  explicit Impl(unsigned threads) {
    if (threads > tbb_concurrency()) control.emplace(tbb::global_control::max_allowed_parallelism, threads);
  }
  std::optional<tbb::global_control> control;
};

TbbThreads::TbbThreads(unsigned threads) : impl_(std::make_unique<Impl>(threads)) {}
TbbThreads::~TbbThreads() = default;

unsigned tbb_concurrency() { return static_cast<unsigned>(std::max(1, tbb::info::default_concurrency())); }

void tbb_within(unsigned threads, void (*work)(const void* context), const void* context) {
  keep_threads();
  tbb::task_arena arena(static_cast<int>(threads));
  arena.execute([&] { work(context); });
}

void tbb_loop(std::size_t count, unsigned threads, void (*body)(const void* context, std::size_t i),
              const void* context) {
  keep_threads();
  tbb::task_arena arena(static_cast<int>(threads));
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { body(context, i); }); });
}

}  // namespace tetwright

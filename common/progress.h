#pragma once

#include <atomic>
#include <string>
#include <string_view>

#include "common/error.h"

namespace tetwright {

/// How long-running functions report and get cancelled. The base class only cancels; a program derives one
/// that draws.
///
/// `begin_stage`, `update` and `finish` are called from the thread that called the long-running function;
/// `cancel` may be called from any thread and from a signal handler.
class Progress {
 public:
  Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  virtual ~Progress() = default;

  /// A new stage of work begins, for example "signed distances".
  virtual void begin_stage(std::string_view /*name*/) {}
  /// The share of the current stage that is done, 0 to 1.
  virtual void update(double /*fraction*/) {}
  /// All stages are done, and what follows may print.
  virtual void finish() {}
  /// The name of the current stage, empty before the first.
  virtual std::string stage() const { return {}; }

  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }
  /// Throws Interrupted once cancel() was called.
  void throw_if_cancelled() const {
    if (cancelled()) throw Interrupted();
  }

 private:
  // Relaxed: the flag carries no data, it only has to arrive some time.
  std::atomic<bool> cancelled_{false};
};

}  // namespace tetwright

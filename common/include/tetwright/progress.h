// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

#include "tetwright/error.h"

namespace tetwright {

/// Progress reports and cancellation of long-running functions. The base class only handles cancellation;
/// derive a class to display progress.
///
/// `begin_stage`, `update`, `finish` and `set_deadline` are called from the thread that called the
/// long-running function; `cancel` may be called from any thread and from a signal handler.
class Progress {
 public:
  Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  virtual ~Progress() = default;

  /// Tells the user something before work that may take long, one line.
  virtual void announce(const std::string& /*line*/) {}
  /// Begins a stage of work, for example "signed distances".
  virtual void begin_stage(std::string_view /*name*/) {}
  /// Reports the fraction of the current stage that is done, 0 to 1.
  virtual void update(double /*fraction*/) {}
  /// Ends the last stage; the caller may print afterwards.
  virtual void finish() {}
  /// Name of the current stage, empty before the first.
  virtual std::string stage() const { return {}; }

  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }

  using Clock = std::chrono::steady_clock;
  static constexpr Clock::time_point no_deadline = Clock::time_point::max();
  /// Sets the time at which the work ends, returning its result so far or throwing OutOfTime.
  void set_deadline(Clock::time_point deadline) noexcept {
    deadline_.store(deadline, std::memory_order_relaxed);
  }
  Clock::time_point deadline() const noexcept { return deadline_.load(std::memory_order_relaxed); }
  bool out_of_time() const noexcept {
    const Clock::time_point end = deadline();
    return end != no_deadline && Clock::now() >= end;
  }

  bool stopped() const noexcept { return cancelled() || out_of_time(); }
  /// \throws Interrupted after cancel()
  /// \throws OutOfTime after the deadline
  void throw_if_stopped() const {
    if (cancelled()) throw Interrupted();
    if (out_of_time()) throw OutOfTime();
  }

 private:
  // Relaxed ordering: neither publishes other data; they only have to become visible eventually.
  std::atomic<bool> cancelled_{false};
  std::atomic<Clock::time_point> deadline_{no_deadline};
};

}  // namespace tetwright

#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "common/error.h"
#include "simplify/mesh/local_numbers.h"

namespace tetwright {

/// An array of try-locks, one byte each. Nobody ever waits, so nothing deadlocks.
///
/// Acquire on taking and release on giving back: what a holder wrote is seen by the next one.
class TryLocks {
 public:
  /// All free. Only while no task runs.
  void reset(std::size_t count) { bytes_ = std::vector<std::atomic<std::uint8_t>>(count); }
  std::size_t size() const { return bytes_.size(); }

  bool try_lock(std::size_t i) {
#ifdef TETWRIGHT_WITHOUT_LOCKS  // only in the test that shows that the thread test notices
    (void)i;
    return true;
#else
    // The load first: a taken lock is then found out without stealing its cache line from the holder. It may
    // be relaxed, since nothing is read on its account.
    return bytes_[i].load(std::memory_order_relaxed) == 0 &&
           bytes_[i].exchange(1, std::memory_order_acquire) == 0;
#endif
  }
  void unlock(std::size_t i) {
#ifdef TETWRIGHT_WITHOUT_LOCKS
    (void)i;
#else
    bytes_[i].store(0, std::memory_order_release);
#endif
  }
  /// For tests: true if every lock is free.
  bool all_free() const {
    for (const auto& byte : bytes_)
      if (byte.load(std::memory_order_relaxed)) return false;
    return true;
  }

 private:
  std::vector<std::atomic<std::uint8_t>> bytes_;
};

/// The locks of one array that one task holds; all are given back at the end of its life. The owner remembers
/// which it holds (by `index` it never takes the same twice).
class HeldLocks {
 public:
  explicit HeldLocks(TryLocks& locks) : locks_(&locks) {}
  ~HeldLocks() { release(); }
  HeldLocks(const HeldLocks&) = delete;
  HeldLocks& operator=(const HeldLocks&) = delete;

  /// False if somebody else holds it. The caller must not hold it already.
  bool try_lock(std::size_t i) {
    // Room first: a failed allocation must not leave a lock behind that nobody knows.
    if (held_.size() == held_.capacity()) held_.reserve(2 * held_.size() + 64);
    if (!locks_->try_lock(i)) return false;
    held_.push_back(static_cast<std::uint32_t>(i));
    if (held_.size() > max_searched) {
      bool added;
      // The first time all that came before; afterwards those are known.
      if (held_.size() == max_searched + 1)
        for (std::uint32_t h : held_) known_.number(h, added);
      known_.number(static_cast<std::uint32_t>(i), added);
    }
    return true;
  }
  void release() {
    for (std::uint32_t i : held_) locks_->unlock(i);
    held_.clear();
    known_.clear();
  }
  std::size_t count() const { return held_.size(); }
  bool holds(std::size_t i) const {
    if (held_.size() > max_searched) return known_.find(static_cast<Index>(i)) != no_index;
    for (std::uint32_t h : held_)
      if (h == i) return true;
    return false;
  }

 private:
  /// Locks that are looked for one by one: more than a star of the usual size has.
  static constexpr std::size_t max_searched = 48;
  TryLocks* locks_;
  std::vector<std::uint32_t> held_;
  LocalNumbers known_;  ///< of held_, once it is longer
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>

namespace tetwright {

/// How far a job is. `recorded` is a moment in which its result may or may not be in the file.
enum class JobState : unsigned char { waiting, running, recorded, ended };

/// How far jobs are, in memory that a process shares with its children: it outlives the child that does them.
/// All functions may be called concurrently, by threads and by processes.
class JobStates {
 public:
  using Clock = std::chrono::steady_clock;

  /// All wait. Throws OutputError where there is no memory.
  explicit JobStates(std::size_t count);
  ~JobStates();
  JobStates(const JobStates&) = delete;
  JobStates& operator=(const JobStates&) = delete;

  std::size_t size() const { return count_; }
  JobState operator[](std::size_t job) const { return entries_[job].state; }
  void set(std::size_t job, JobState state) { entries_[job].state = state; }
  /// Sets it running, from now.
  void begin(std::size_t job);
  /// Seconds since begin().
  double seconds(std::size_t job) const;

 private:
  struct Entry {
    std::atomic<JobState> state;
    std::atomic<Clock::rep> begun;
  };
  static_assert(std::atomic<Clock::rep>::is_always_lock_free);

  Entry* entries_;
  std::size_t count_;
};

/// How a process ended: with a status of its own, or by a signal, which is 0 in the first case.
struct ProcessEnd {
  int id = 0;
  int status = 0;
  int signal = 0;
};

/// Lets a child process do the work, and waits until it has ended. The child is a copy of this process, and
/// ends with the status that `work` returns (which must not throw) without the destructors of global objects:
/// libraries may have started threads, which a child does not have. Under Linux it is killed when this
/// process ends. SIGHUP, SIGINT and SIGTERM are handed on to it; one that finds it dying of something else
/// takes effect here when it has gone. Call it before there are threads that matter to the work. Throws
/// OutputError where no process can be started or waited for.
ProcessEnd run_in_child_process(const std::function<int()>& work);

}  // namespace tetwright

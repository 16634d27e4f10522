// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>

namespace tetwright {

/// Progress of a job. In the state `recorded` the result may or may not be in the file yet.
enum class JobState : unsigned char { waiting, running, recorded, ended };

/// Progress of all jobs, in memory shared with child processes, so that it outlives the child that runs the
/// jobs. All functions may be called concurrently from threads and processes.
class JobStates {
 public:
  using Clock = std::chrono::steady_clock;

  /// Sets all jobs to `waiting`.
  ///
  /// \throws OutputError if there is not enough memory
  explicit JobStates(std::size_t count);
  ~JobStates();
  JobStates(const JobStates&) = delete;
  JobStates& operator=(const JobStates&) = delete;

  std::size_t size() const { return count_; }
  JobState operator[](std::size_t job) const { return entries_[job].state; }
  void set(std::size_t job, JobState state) { entries_[job].state = state; }
  /// Marks the job as running and starts its clock.
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

/// How a process ended: its exit status, or the signal that ended it and otherwise 0.
struct ProcessEnd {
  int id = 0;
  int status = 0;
  int signal = 0;
};

/// Forks a child process, runs the work in it and waits for its end. The child exits without destructors of
/// global objects, since threads that libraries have started do not exist in it. On Linux it is killed when
/// this process ends. SIGHUP, SIGINT and SIGTERM are forwarded to it; a signal that arrives while the child
/// dies of another cause takes effect in this process afterwards.
///
/// \param work returns the child's exit status; must not throw
/// \throws OutputError if no process can be started or waited for
/// \pre No threads that the work needs have been started.
ProcessEnd run_in_child_process(const std::function<int()>& work);

}  // namespace tetwright

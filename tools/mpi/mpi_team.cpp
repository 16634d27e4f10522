// SPDX-License-Identifier: Apache-2.0
#include "tools/mpi/mpi_team.h"

#include <mpi.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

#include "tetwright/error.h"
#include "tools/app/exit_status.h"
#include "tools/bricks/brick_bytes.h"

namespace tetwright {

namespace {

/// Kinds of messages.
enum Tag : int {
  ask,      ///< helper to leader: the hash of its job; which brick next?
  answer,   ///< leader to helper: an Answer
  size,     ///< helper to leader: a Size, followed by the brick's bytes
  bytes,    ///< helper to leader: at most max_message of them
  failure,  ///< helper to leader: exit status, followed by a text
  text,     ///< helper to leader
  leave     ///< leader to helper: the program ends
};

using Job = std::array<std::int64_t, 1>;     ///< hash
using Answer = std::array<std::int64_t, 4>;  ///< the members of a BrickTask
using Size = std::array<std::int64_t, 2>;    ///< brick and number of bytes
constexpr std::int64_t no_brick = -1;

/// Bytes: MPI counts them by an int.
constexpr std::size_t max_message = std::size_t{1} << 30;

/// Short beside the time of a brick, long beside that of a look.
constexpr std::chrono::milliseconds between_looks(2);

template <class Numbers>
void send(const Numbers& numbers, int to, Tag tag) {
  MPI_Send(numbers.data(), static_cast<int>(numbers.size()), MPI_INT64_T, to, tag, MPI_COMM_WORLD);
}

template <class Numbers>
Numbers receive_numbers(int from, Tag tag) {
  Numbers numbers{};
  MPI_Recv(numbers.data(), static_cast<int>(numbers.size()), MPI_INT64_T, from, tag, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  return numbers;
}

void send_bytes(const std::string& all, int to, Tag tag) {
  for (std::size_t at = 0; at < all.size(); at += max_message)
    MPI_Send(all.data() + at, static_cast<int>(std::min(max_message, all.size() - at)), MPI_BYTE, to, tag,
             MPI_COMM_WORLD);
}

std::string receive_bytes(std::size_t size, int from, Tag tag) {
  std::string all(size, '\0');
  for (std::size_t at = 0; at < size; at += max_message)
    MPI_Recv(all.data() + at, static_cast<int>(std::min(max_message, size - at)), MPI_BYTE, from, tag,
             MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return all;
}

/// Whether a message has arrived that begins an exchange.
bool arrived(int from, int tag, MPI_Status& status) {
  int flag = 0;
  MPI_Iprobe(from, tag, MPI_COMM_WORLD, &flag, &status);
  return flag != 0;
}

/// Waits for a message without occupying a core.
void wait_for(int from, int tag) {
  MPI_Status status;
  while (!arrived(from, tag, status)) std::this_thread::sleep_for(between_looks);
}

/// Throws what the failure of a helper would have been here.
[[noreturn]] void fail_as(int rank, int status, const std::string& message) {
  const std::string what = message + " (rank " + std::to_string(rank) + ")";
  switch (static_cast<ExitStatus>(status)) {
    case ExitStatus::usage:
      throw UsageError(what);
    case ExitStatus::bad_input:
      throw InputError(what);
    case ExitStatus::nothing_to_mesh:
      throw NothingToMeshError(what);
    case ExitStatus::interrupted:
      throw Interrupted();
    case ExitStatus::internal_error:
      throw InternalError(what);
    default:
      throw OutputError(what);
  }
}

}  // namespace

/// Answers helpers while bricks are made.
class MpiTeam::Service {
 public:
  Service(MpiTeam& team, std::deque<BrickTask> tasks, const Receive& receive)
      : team_(team), tasks_(std::move(tasks)), left_(tasks_.size()), receive_(receive) {}

  /// The next brick for the leader, if there is one.
  bool next(BrickTask& task) {
    const std::lock_guard guard(mutex_);
    if (tasks_.empty() || failed_) return false;
    task = tasks_.front();
    tasks_.pop_front();
    return true;
  }
  /// Passes on a brick that has been made.
  void deliver(std::size_t brick, const std::string& data) {
    const std::lock_guard guard(mutex_);
    receive_(brick, data);
    --left_;
  }
  void stop() { failed_ = true; }

  /// Answers helpers until all bricks have been delivered.
  void run() {
    try {
      while (left_ > 0 && !failed_) {
        answer_waiting();
        MPI_Status status;
        if (team_.helper_asked()) continue;
        if (arrived(MPI_ANY_SOURCE, size, status)) {
          const auto [brick, count] = receive_numbers<Size>(status.MPI_SOURCE, size);
          deliver(static_cast<std::size_t>(brick),
                  receive_bytes(static_cast<std::size_t>(count), status.MPI_SOURCE, bytes));
        } else {
          team_.progress_->throw_if_stopped();
          std::this_thread::sleep_for(between_looks);
        }
      }
    } catch (...) {
      error_ = std::current_exception();
      failed_ = true;
    }
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void answer_waiting() {
    BrickTask task{};
    while (!team_.waiting_.empty() && next(task)) {
      team_.give(team_.waiting_.front(), task);
      team_.waiting_.pop_front();
    }
  }

  MpiTeam& team_;
  std::mutex mutex_;  ///< of tasks_ and receive_
  std::deque<BrickTask> tasks_;
  std::atomic<std::size_t> left_;
  std::atomic<bool> failed_ = false;
  std::exception_ptr error_;
  const Receive& receive_;
};

MpiTeam::MpiTeam() {
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

void MpiTeam::give(int helper, const BrickTask& task) const {
  send(Answer{static_cast<std::int64_t>(task.brick), task.halo, task.keep_surface, task.thin}, helper,
       answer);
}

void MpiTeam::lead(const std::vector<BrickTask>& tasks, const Make& make, const Receive& receive) {
  Service service(*this, {tasks.begin(), tasks.end()}, receive);
  std::thread thread([&] { service.run(); });
  std::exception_ptr error;
  try {
    for (BrickTask task{}; service.next(task);) service.deliver(task.brick, to_bytes(make(task)));
  } catch (...) {
    error = std::current_exception();
    service.stop();
  }
  thread.join();
  if (error) std::rethrow_exception(error);
  service.rethrow();
}

void MpiTeam::begin(const std::string& job, const Progress& progress) {
  progress_ = &progress;
  job_ = 0;
  for (const char c : job) job_ = 0x100000001b3 * (job_ ^ static_cast<unsigned char>(c));  // FNV-1
}

bool MpiTeam::helper_asked() {
  MPI_Status status;
  if (arrived(MPI_ANY_SOURCE, failure, status)) {
    const auto [code, count] = receive_numbers<Size>(status.MPI_SOURCE, failure);
    fail_as(status.MPI_SOURCE, static_cast<int>(code),
            receive_bytes(static_cast<std::size_t>(count), status.MPI_SOURCE, text));
  }
  if (!arrived(MPI_ANY_SOURCE, ask, status)) return false;
  const auto [job] = receive_numbers<Job>(status.MPI_SOURCE, ask);
  if (static_cast<std::uint64_t>(job) != job_)
    throw UsageError(
        "rank " + std::to_string(status.MPI_SOURCE) +
        " has another job than rank 0: other options, other voxels in its file or, since its memory is "
        "another one, other cells or rounds; give all ranks the same, --voxel-size and --brick-rounds");
  waiting_.push_back(status.MPI_SOURCE);
  return true;
}

void MpiTeam::end() {
  for (int left = size_ - 1; left > 0; --left) {
    while (waiting_.empty() && !helper_asked()) {
      progress_->throw_if_stopped();
      std::this_thread::sleep_for(between_looks);
    }
    send(Answer{no_brick, 0, 0, 0}, waiting_.front(), answer);
    waiting_.pop_front();
  }
}

void MpiTeam::help(const Make& make) {
  has_news_ = false;
  for (;;) {
    send(Job{static_cast<std::int64_t>(job_)}, 0, ask);
    wait_for(0, answer);
    const auto [brick, halo, keep_surface, thin] = receive_numbers<Answer>(0, answer);
    if (brick == no_brick) return;
    const std::string data = to_bytes(
        make({static_cast<std::size_t>(brick), static_cast<int>(halo), keep_surface != 0, thin != 0}));
    send(Size{brick, static_cast<std::int64_t>(data.size())}, 0, size);
    send_bytes(data, 0, bytes);
  }
}

void MpiTeam::report(int status, const std::string& message) {
  has_news_ = false;
  send(Size{status, static_cast<std::int64_t>(message.size())}, 0, failure);
  send_bytes(message, 0, text);
}

void MpiTeam::part() {
  if (is_leader()) {
    for (int helper = 1; helper < size_; ++helper)
      MPI_Send(nullptr, 0, MPI_BYTE, helper, leave, MPI_COMM_WORLD);
  } else {
    if (has_news_)
      report(static_cast<int>(ExitStatus::usage),
             "it ended without making bricks; give all ranks the same call");
    wait_for(0, leave);
    MPI_Recv(nullptr, 0, MPI_BYTE, 0, leave, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  }
}

}  // namespace tetwright

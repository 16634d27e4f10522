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
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "tetwright/error.h"
#include "tools/app/exit_status.h"
#include "tools/mpi/end_all_ranks.h"
#ifdef TETWRIGHT_PARALLEL_HDF5
#include "common/files/byte_archive.h"
#include "tools/mpi/parallel_hdf5.h"
#endif

namespace tetwright {

namespace {

/// Kinds of messages. Numbers are followed by as many bytes as they say, in messages of the same kind.
enum Tag : int {
  ask,      ///< helper to leader: the hash of its job; which task next?
  order,    ///< leader to helper: an Item
  result,   ///< helper to leader: an Item
  failure,  ///< helper to leader: an Item, exit status and a text
  leave     ///< leader to helper: the program ends
};

using Job = std::array<std::int64_t, 1>;   ///< hash
using Item = std::array<std::int64_t, 2>;  ///< task and number of bytes
/// No task; a file for all to write: its names, then one content after the other.
constexpr std::int64_t no_task = -1, hdf5_file = -2;

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

/// Sends an Item with its bytes.
void send_item(std::int64_t number, const std::string& all, int to, Tag tag) {
  send(Item{number, static_cast<std::int64_t>(all.size())}, to, tag);
  for (std::size_t at = 0; at < all.size(); at += max_message)
    MPI_Send(all.data() + at, static_cast<int>(std::min(max_message, all.size() - at)), MPI_BYTE, to, tag,
             MPI_COMM_WORLD);
}

/// \return the Item's number, and its bytes
std::pair<std::int64_t, std::string> receive_item(int from, Tag tag) {
  const auto [number, count] = receive_numbers<Item>(from, tag);
  std::string all(static_cast<std::size_t>(count), '\0');
  for (std::size_t at = 0; at < all.size(); at += max_message)
    MPI_Recv(all.data() + at, static_cast<int>(std::min(max_message, all.size() - at)), MPI_BYTE, from, tag,
             MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return {number, std::move(all)};
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

/// Answers helpers while tasks are done.
class MpiTeam::Service {
 public:
  Service(MpiTeam& team, const Tasks& tasks) : team_(team), tasks_(tasks), left_(tasks.count) {}

  /// The next task for the leader, if there is one.
  bool next(std::size_t& task) {
    const std::lock_guard guard(mutex_);
    if (next_ == tasks_.count || failed_) return false;
    task = next_++;
    return true;
  }
  void done() { --left_; }
  void stop() { failed_ = true; }

  /// Answers helpers until all tasks are done.
  void run() {
    try {
      while (left_ > 0 && !failed_) {
        answer_waiting();
        if (team_.helper_asked()) continue;
        MPI_Status status;
        if (arrived(MPI_ANY_SOURCE, result, status)) {
          const auto [task, bytes] = receive_item(status.MPI_SOURCE, result);
          tasks_.receive(static_cast<std::size_t>(task), bytes);
          ++by_helpers_;
          done();
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
  /// Throws the error of run(), if there was one.
  /// \return number of tasks that helpers did
  std::size_t by_helpers() const {
    if (error_) std::rethrow_exception(error_);
    return by_helpers_;
  }

 private:
  void answer_waiting() {
    std::size_t task = 0;
    while (!team_.waiting_.empty() && next(task)) {
      send_item(static_cast<std::int64_t>(task), tasks_.order(task), team_.waiting_.front(), order);
      team_.waiting_.pop_front();
    }
  }

  MpiTeam& team_;
  const Tasks& tasks_;
  std::mutex mutex_;  ///< of next_
  std::size_t next_ = 0;
  std::atomic<std::size_t> left_;
  std::atomic<bool> failed_ = false;
  std::exception_ptr error_;
  std::size_t by_helpers_ = 0;
};

MpiTeam::MpiTeam() {
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

std::size_t MpiTeam::lead(const Tasks& tasks) {
  Service service(*this, tasks);
  std::thread thread([&] { service.run(); });
  std::exception_ptr error;
  try {
    for (std::size_t task = 0; service.next(task); service.done()) tasks.here(task);
  } catch (...) {
    error = std::current_exception();
    service.stop();
  }
  thread.join();
  if (error) std::rethrow_exception(error);
  return service.by_helpers();
}

void MpiTeam::begin(const std::string& job, const Progress& progress) {
  progress_ = &progress;
  job_ = 0;
  for (const char c : job) job_ = 0x100000001b3 * (job_ ^ static_cast<unsigned char>(c));  // FNV-1
}

bool MpiTeam::helper_asked() {
  MPI_Status status;
  if (arrived(MPI_ANY_SOURCE, failure, status)) {
    const auto [code, text] = receive_item(status.MPI_SOURCE, failure);
    fail_as(status.MPI_SOURCE, static_cast<int>(code), text);
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

void MpiTeam::wait_for_helper() {
  while (!helper_asked()) {
    progress_->throw_if_stopped();
    std::this_thread::sleep_for(between_looks);
  }
}

#ifdef TETWRIGHT_PARALLEL_HDF5

bool MpiTeam::writes_hdf5() const { return true; }

std::size_t MpiTeam::write_hdf5(const std::string& temporary, const std::string& path,
                                const std::function<void(Hdf5Writer&)>& content) {
  while (waiting_.size() + 1 < static_cast<std::size_t>(size_)) wait_for_helper();
  ByteWriter names;
  names(temporary, path);
  for (const int helper : waiting_) send_item(hdf5_file, names.bytes, helper, order);
  waiting_.clear();
  ParallelHdf5 file(temporary, path,
                    {[&](const std::string& bytes, int helper) {
                       progress_->throw_if_stopped();
                       send_item(hdf5_file, bytes, helper, order);
                     },
                     {}});
  content(file);
  file.close();
  return static_cast<std::size_t>(size_);
}

namespace {

/// A helper's part of write_hdf5().
void help_with_hdf5(const std::string& order_of_file) {
  std::string temporary, path;
  try {
    ByteReader(order_of_file, "an HDF5 file", "the message with its name is incomplete")(temporary, path);
  } catch (const std::exception& e) {
    end_all_ranks({}, "an HDF5 file", e.what());
  }
  ParallelHdf5(temporary, path,
               {{},
                [] {
                  wait_for(0, order);
                  return receive_item(0, order).second;
                }})
      .follow();
}

}  // namespace

#else

bool MpiTeam::writes_hdf5() const { return false; }
std::size_t MpiTeam::write_hdf5(const std::string&, const std::string&,
                                const std::function<void(Hdf5Writer&)>&) {
  throw InternalError("this build has no parallel HDF5");
}
namespace {
void help_with_hdf5(const std::string&) {
  end_all_ranks({}, "an HDF5 file",
                "this rank's build has no parallel HDF5; give all ranks the same program");
}
}  // namespace

#endif

void MpiTeam::end() {
  std::set<int> ended;
  std::deque<int> for_next_kind;
  while (ended.size() + 1 < static_cast<std::size_t>(size_)) {
    if (waiting_.empty()) wait_for_helper();
    const int helper = waiting_.front();
    waiting_.pop_front();
    if (ended.insert(helper).second)
      send_item(no_task, {}, helper, order);
    else
      for_next_kind.push_back(helper);
  }
  waiting_ = std::move(for_next_kind);
}

void MpiTeam::help(const Work& work) {
  has_news_ = false;
  for (;;) {
    send(Job{static_cast<std::int64_t>(job_)}, 0, ask);
    wait_for(0, order);
    const auto [task, bytes] = receive_item(0, order);
    if (task == no_task) return;
    if (task == hdf5_file)
      help_with_hdf5(bytes);
    else
      send_item(task, work(bytes), 0, result);
  }
}

void MpiTeam::report(int status, const std::string& message) {
  has_news_ = false;
  send_item(status, message, 0, failure);
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

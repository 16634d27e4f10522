// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace tetwright {

/// Number of threads that the machine can run at the same time.
unsigned hardware_threads();

/// Maximum number of threads of parallel work: 16, or four for each hardware thread if that is more. Further
/// threads would wait for each other and slow the work down.
unsigned max_threads();

/// Limits parallel work started by the constructing thread to `threads` threads, at most max_threads(),
/// during the object's lifetime. Other threads and loops of other libraries are not affected (see
/// with_threads()). Destroy objects on the constructing thread, in reverse order of construction.
/// \param threads 0: hardware_threads()
class ThreadLimit {
 public:
  explicit ThreadLimit(unsigned threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Current maximum number of threads of a loop started by the calling thread.
unsigned thread_count();

/// Calls `work` under a ThreadLimit of `threads` that also applies to loops of OpenVDB. Several threads may
/// call this at the same time, each with its own number. Rethrows an exception of `work`.
void with_threads(unsigned threads, const std::function<void()>& work);

/// Calls `body(begin, end)` for disjoint parts of [begin, end) of `grain` items each (the last may have
/// fewer), concurrently, on no more threads than there are parts. Writes of the bodies are visible to the
/// caller afterwards. The first exception ends the loop and is rethrown.
void parallel_for(std::size_t begin, std::size_t end, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body);

/// Calls `body(chunk, worker)` once for each chunk in [0, chunks), on at most thread_count() workers,
/// numbered from 0. Each worker takes the next chunk after finishing one, and runs on one thread at a time,
/// so its data needs no lock. With one thread the chunks run in order. After an exception no worker takes
/// another chunk; the first exception is rethrown.
void parallel_chunks(std::size_t chunks, const std::function<void(std::size_t, unsigned)>& body);

/// Sum of `body(begin, end)` over parts of [begin, end) whose bounds depend only on `grain`. The parts are
/// added in order, so that rounding is the same for any number of threads.
double parallel_sum(std::size_t begin, std::size_t end, std::size_t grain,
                    const std::function<double(std::size_t, std::size_t)>& body);

/// Total memory that this process may use, bytes: the minimum of
/// - the memory of the machine,
/// - the limits of the container (control groups of version 1 and 2: the process's own group and all its
///   ancestors),
/// - the limits on address space and data (RLIMIT_AS, RLIMIT_DATA),
/// - the MemoryLimit of the calling thread,
///
/// less the HeldMemory of the calling thread.
///
/// Memory in use by other processes is not subtracted. May be called concurrently.
/// \param root folder in which /proc and /sys are looked up; a missing file sets no limit
double available_memory(const std::filesystem::path& root = "/");

/// Limits available_memory() on the constructing thread during the object's lifetime. Bytes; 0: no limit.
class MemoryLimit {
 public:
  explicit MemoryLimit(double bytes);
  ~MemoryLimit();
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  double before_;
};

/// Reduces available_memory() on the constructing thread by memory that is in use and in no estimate, such as
/// that of images which wait for the mesh.
class HeldMemory {
 public:
  HeldMemory() = default;
  /// \param bytes see add()
  explicit HeldMemory(double bytes) { add(bytes); }
  ~HeldMemory() { add(-bytes_); }
  HeldMemory(const HeldMemory&) = delete;
  HeldMemory& operator=(const HeldMemory&) = delete;

  /// \param bytes negative: released
  void add(double bytes);

 private:
  double bytes_ = 0;
};

/// Checks that `bytes` can be allocated.
/// \throws OutputError if `bytes` exceeds available_memory(): "<what> would take about 12.3 GB of memory, and
///   8 GB are available; <remedy>", with the HeldMemory
void require_memory(double bytes, const std::string& what, const std::string& remedy);

}  // namespace tetwright

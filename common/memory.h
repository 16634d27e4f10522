// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace tetwright {

/// The memory that this process may use in all, bytes: the smallest of what the machine has, of the limits of
/// the container (control groups of version 1 and 2: the process's own group and all above it) and of the
/// limits on the address space and on data (RLIMIT_AS, RLIMIT_DATA), and of a MemoryLimit of this thread.
/// What other processes use is not taken off.
///
/// `root` is the folder that /proc and /sys are looked for in; files that are not there set no limit. May be
/// called concurrently.
double available_memory(const std::filesystem::path& root = "/");

/// What the thread that makes it may use, as far as require_memory() is asked on that thread, until its end;
/// in bytes, 0 for no limit.
class MemoryLimit {
 public:
  explicit MemoryLimit(double bytes);
  ~MemoryLimit();
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  double before_;
};

/// Throws OutputError where `bytes` are more than available_memory(): "<what> would take about 12.3 GB of
/// memory, and 8 GB are available; <remedy>".
void require_memory(double bytes, const std::string& what, const std::string& remedy);

}  // namespace tetwright

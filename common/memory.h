// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace tetwright {

/// Memory that this process may use in total, bytes: the minimum of
/// - the memory of the machine,
/// - the limits of the container (control groups of version 1 and 2: the process's own group and all its
///   ancestors),
/// - the limits on address space and data (RLIMIT_AS, RLIMIT_DATA),
/// - the MemoryLimit of the calling thread.
///
/// Memory in use by other processes is not subtracted. May be called concurrently.
/// \param root folder in which /proc and /sys are looked up; a missing file sets no limit
double available_memory(const std::filesystem::path& root = "/");

/// Limits available_memory() on the constructing thread until destruction. Bytes; 0: no limit.
class MemoryLimit {
 public:
  explicit MemoryLimit(double bytes);
  ~MemoryLimit();
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  double before_;
};

/// Checks that `bytes` can be allocated.
/// \throws OutputError if `bytes` exceeds available_memory(): "<what> would take about 12.3 GB of memory, and
///   8 GB are available; <remedy>"
void require_memory(double bytes, const std::string& what, const std::string& remedy);

}  // namespace tetwright

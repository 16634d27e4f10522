// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tetwright {

/// Runs `work` in a forked child process, so that its memory is measured alone and is released at the end.
///
/// \return the result of `work`; {"error": "..."} if it threw an exception or died.
/// \pre This process has a single thread.
nlohmann::json in_child(const std::function<nlohmann::json()>& work);

struct ProgramRun {
  int status = 0;              ///< exit status, as in a shell
  double seconds = 0;          ///< wall time
  double cpu_seconds = 0;      ///< processor time of all threads, also in the system
  std::size_t peak_bytes = 0;  ///< peak resident size
};

/// Runs a program to its end and discards its standard output.
ProgramRun run_program(const std::vector<std::string>& arguments);

/// Peak resident size of this process since its start or reset_peak() (VmHWM).
std::size_t peak_bytes_now();
/// Current resident size of this process (VmRSS).
std::size_t resident_bytes_now();
/// Returns free memory to the system and resets the peak to the current resident size.
void reset_peak();

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Processor time of the calling thread: waiting on a busy machine is not counted.
class ThreadStopwatch {
 public:
  double seconds() const { return now() - start_; }

 private:
  static double now();
  double start_ = now();
};

/// A folder in the system's temporary folder; removed with its contents on destruction.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

/// Writes JSON; does nothing if the path is empty.
///
/// \throws OutputError if the file cannot be written.
void write_json(const nlohmann::json& json, const std::string& path);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tetwright {

/// Carries `work` out in a forked child and hands back what it returned: its memory is its own then, and what
/// it leaves behind is gone. {"error": "..."} if it threw or died. To be called while this process has a
/// single thread.
nlohmann::json in_child(const std::function<nlohmann::json()>& work);

struct ProgramRun {
  int status = 0;              ///< as a shell gives it
  double seconds = 0;          ///< from start to end
  std::size_t peak_bytes = 0;  ///< largest resident size
};

/// Runs a program to its end; what it prints on stdout is dropped.
ProgramRun run_program(const std::vector<std::string>& arguments);

/// Largest resident size of this process since its start or reset_peak() (VmHWM).
std::size_t peak_bytes_now();
/// What of this process is resident now (VmRSS).
std::size_t resident_bytes_now();
/// Gives free memory back to the system and begins the peak anew at what is resident.
void reset_peak();

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Processor time of the thread that asks: what waits for others on a busy machine does not count.
class ThreadStopwatch {
 public:
  double seconds() const { return now() - start_; }

 private:
  static double now();
  double start_ = now();
};

/// A folder in the system's temporary one, removed with all that is in it.
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

/// Writes JSON, or throws OutputError; nothing to do for an empty path.
void write_json(const nlohmann::json& json, const std::string& path);

}  // namespace tetwright

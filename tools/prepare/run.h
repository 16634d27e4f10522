// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "common/memory.h"
#include "common/mesh/midside_nodes.h"
#include "common/progress.h"
#include "tools/prepare/inputs.h"
#include "tools/prepare/options.h"
#include "tools/prepare/report.h"

namespace tetwright {

class Stopwatch {
 public:
  /// Since construction.
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The kinds of results that can be asked for.
enum class Task {
  prepare,   ///< scans to a simulation mesh
  mesh,      ///< scans to a dense mesh
  simplify,  ///< a tet mesh to one of fewer tets
  improve    ///< better shapes at about the same count
};
/// "prepare"
const char* name_of(Task task);

/// The state that the steps of one result share. The meshes themselves are handed from step to step. Limits
/// on time and memory begin when it is made, and hold for the thread that makes it.
struct PrepareRun {
  /// All arguments must outlive it. `to` may have findings already.
  PrepareRun(Task what, const PrepareOptions& of, Progress& shown, PrepareReport& to);

  /// Until the limit; 0 where it has passed, infinite where there is none.
  double seconds_left() const;
  /// Work on the mesh ends this many seconds before the limit, or earlier if it was told so before: what
  /// comparing and writing the mesh are expected to take.
  void reserve_time(double seconds);

  Task task;
  const PrepareOptions& options;
  MemoryLimit memory_limit;
  Stopwatch since_start;
  Progress& progress;
  double seconds_waited = 0;  ///< for streams
  PrepareReport& report;
  std::optional<MidsideNodes> midside;  ///< of the result, with order 2
};

/// Adds to the diagnostics what a reader dropped from `file`. Items that are restored from the mesh are added
/// only if `with_restored`.
void report_dropped(const std::vector<Dropped>& dropped, const std::string& file, PrepareReport& report,
                    bool with_restored = true);

}  // namespace tetwright

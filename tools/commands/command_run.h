#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "common/formats/dropped.h"
#include "common/mesh/midside_nodes.h"
#include "common/parallel/parallel.h"
#include "tools/command_line.h"
#include "tools/progress_bar.h"
#include "tools/run_report.h"

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

/// What all steps of a command share. The meshes themselves are handed from step to step.
struct CommandRun {
  /// Limits the threads to what `line` allows; `line` must outlive this object.
  explicit CommandRun(const CommandLine& line);

  const CommandLine& line;
  Stopwatch since_start;
  ThreadLimit threads;
  ProgressBar progress;
  RunReport report;
  std::optional<MidsideNodes> midside;  ///< of the result, with --order 2
};

/// The files that a command reads: the positional inputs, then those of --material. Empty for `sample`.
std::vector<std::string> input_files(const CommandLine& line);

/// Adds to the findings what a reader dropped from `file`. Items that are restored from the mesh are added
/// only if `with_restored`.
void report_dropped(const std::vector<Dropped>& dropped, const std::string& file, RunReport& report,
                    bool with_restored = true);

}  // namespace tetwright

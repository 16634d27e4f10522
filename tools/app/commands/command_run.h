// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tetwright/files.h"
#include "tetwright/prepare.h"
#include "tetwright/prepare_steps.h"
#include "tetwright/progress.h"
#include "tetwright/resources.h"
#include "tools/app/command_line.h"
#include "tools/app/commands/named_inputs.h"
#include "tools/app/exit_status.h"
#include "tools/report/page/surface_distances.h"

namespace tetwright {

/// A command that is being carried out, and how it ended.
struct CommandRun {
  /// All arguments must outlive it. Inputs are moved out of `in_memory` as they are read. The memory of
  /// --memory-limit is that of its life, on the thread that makes it.
  CommandRun(const CommandLine& line, Progress& progress, NamedInputs* in_memory = nullptr);

  const CommandLine& line;
  MemoryLimit memory_limit;
  Stopwatch since_start;
  Progress& progress;
  NamedInputs* in_memory;
  PrepareReport report;
  ExitStatus status = ExitStatus::done;
  std::string error, stage;  ///< of a run that failed: its message, and the stage in which it did
  std::optional<SurfaceDistances> distances;  ///< of the result, with --report where there is a surface
};

/// Adds the statistics to the files, unless there are none or they go to standard output.
void write_stats(const CommandRun& run, OutputFiles& files);

/// The names of the inputs: the positional ones, then those of --material. Empty for `sample`.
std::vector<std::string> input_files(const CommandLine& line);

}  // namespace tetwright

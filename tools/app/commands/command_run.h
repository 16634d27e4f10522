// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tetwright/embedding.h"
#include "tetwright/files.h"
#include "tetwright/loop_times.h"
#include "tetwright/partition.h"
#include "tetwright/prepare.h"
#include "tetwright/prepare_steps.h"
#include "tetwright/progress.h"
#include "tetwright/resources.h"
#include "tools/app/command_line.h"
#include "tools/app/commands/named_inputs.h"
#include "tools/app/exit_status.h"
#include "tools/report/page/surface_distances.h"

namespace tetwright {

/// Outcome of `embed`.
struct EmbeddingReport {
  EmbeddingSummary summary;
  std::size_t tets = 0;  ///< of the mesh
  double seconds = 0;    ///< for the weights
};

/// State and outcome of a command.
struct CommandRun {
  /// Sets the limit of --memory-limit and counts loops, both on the constructing thread until destruction.
  ///
  /// \param in_memory may be null; inputs are moved out of it when they are read
  /// \pre All arguments outlive the run.
  CommandRun(const CommandLine& line, Progress& progress, NamedInputs* in_memory = nullptr);

  const CommandLine& line;
  MemoryLimit memory_limit;
  CountLoops counted_loops;
  Stopwatch since_start;
  Progress& progress;
  NamedInputs* in_memory;
  PrepareReport report;
  ExitStatus status = ExitStatus::done;
  std::optional<PartitionStatistics> parts;  ///< of the mesh, with --parts
  /// Pieces of it that other members of a team wrote, if they are files of their own.
  std::optional<std::size_t> pieces_by_helpers;
  std::optional<std::size_t> hdf5_ranks;      ///< members of a team that wrote HDF5 files together
  std::optional<EmbeddingReport> embedding;   ///< with `embed`
  std::string error, stage;                   ///< message and stage of a run that failed
  std::optional<SurfaceDistances> distances;  ///< distances of the result; only with --report and a surface
};

/// Adds the statistics to the files, unless --stats is missing or standard output.
void write_stats(const CommandRun& run, OutputFiles& files);

/// Names of the inputs: the positional ones, then those of --material. Empty for `sample`.
std::vector<std::string> input_files(const CommandLine& line);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <memory>

#include "mesher/mesher.h"
#include "tools/app/command_line.h"
#include "tools/app/commands/command_run.h"
#include "tools/app/exit_status.h"

namespace tetwright {

/// Carries out the command of `line`, writes and prints its result. Throws Error for everything that ends it
/// early.
ExitStatus run_command(const CommandLine& line);

/// What a command that makes a mesh made, before anything is written.
struct CommandResult {
  TetMesh mesh;
  std::shared_ptr<const MaterialField> field;  ///< for --write-sdf; may be null without it
};

/// Carries out prepare, mesh, simplify or improve; `run.report` says all of the result. Neither writes nor
/// prints. Throws as run_command() does.
CommandResult make_result(CommandRun& run);

/// Writes the statistics of a run that failed. That they cannot be written either is said, and the run's own
/// error matters more.
void report_failure(const std::exception& error, CommandRun& run);

CommandResult run_prepare(CommandRun& run);
CommandResult run_mesh(CommandRun& run);
CommandResult run_simplify(CommandRun& run);
CommandResult run_improve(CommandRun& run);

/// `check`, without printing: writes the files that `run.line` asks for. Throws as run_command() does.
CheckReport make_check(CommandRun& run);

void run_check(CommandRun& run);
/// Prints a line for each job that ends.
void run_batch(CommandRun& run);
void run_sample(CommandRun& run);

}  // namespace tetwright

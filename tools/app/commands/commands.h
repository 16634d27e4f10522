// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>

#include "tetwright/embedding.h"
#include "tetwright/prepare.h"
#include "tools/app/command_line.h"
#include "tools/app/commands/command_run.h"
#include "tools/app/exit_status.h"
#include "tools/compare/check_report.h"

namespace tetwright {

/// Runs the command of `line`, and writes and prints its result.
///
/// \throws Error if the command fails
ExitStatus run_command(const CommandLine& line);

/// Runs prepare, mesh, simplify or improve without writing or printing. `run.report` becomes the report of
/// the result.
///
/// \throws Error in the cases of run_command()
Prepared make_result(CommandRun& run);

/// Records the error of a failed run and writes its statistics. Does not throw: if the statistics cannot be
/// written either, it prints a line.
void report_failure(const std::exception& error, CommandRun& run);

/// Runs `check` without printing, and writes the files of `run.line`.
///
/// \throws Error in the cases of run_command()
CheckReport make_check(CommandRun& run);

/// Runs `embed` without writing or printing.
///
/// \throws Error in the cases of run_command()
Embedding make_embedding(CommandRun& run);
/// Writes the weights and the statistics to the files of `run.line`.
///
/// \throws OutputError if a file cannot be written
void write_embedding(const Embedding& made, CommandRun& run);

void run_check(CommandRun& run);
void run_embed(CommandRun& run);
/// Runs the jobs of a batch, and prints a line whenever one ends.
void run_batch(CommandRun& run);
void run_sample(CommandRun& run);

}  // namespace tetwright

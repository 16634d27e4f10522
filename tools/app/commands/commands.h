// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>

#include "tetwright/prepare.h"
#include "tools/app/command_line.h"
#include "tools/app/commands/command_run.h"
#include "tools/app/exit_status.h"
#include "tools/compare/check_report.h"

namespace tetwright {

/// Carries out the command of `line`, writes and prints its result. Throws Error for everything that ends it
/// early.
ExitStatus run_command(const CommandLine& line);

/// Carries out prepare, mesh, simplify or improve; `run.report` says all of the result. Neither writes nor
/// prints. Throws as run_command() does.
Prepared make_result(CommandRun& run);

/// Writes the statistics of a run that failed. That they cannot be written either is said, and the run's own
/// error matters more.
void report_failure(const std::exception& error, CommandRun& run);

/// `check`, without printing: writes the files that `run.line` asks for. Throws as run_command() does.
CheckReport make_check(CommandRun& run);

void run_check(CommandRun& run);
/// Prints a line for each job that ends.
void run_batch(CommandRun& run);
void run_sample(CommandRun& run);

}  // namespace tetwright

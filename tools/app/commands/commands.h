// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>

#include "tetwright/prepare.h"
#include "tools/app/command_line.h"
#include "tools/app/commands/command_run.h"
#include "tools/app/exit_status.h"
#include "tools/compare/check_report.h"

namespace tetwright {

/// Runs the command of `line`; writes and prints its result.
///
/// \throws Error if the command ends early
ExitStatus run_command(const CommandLine& line);

/// Runs prepare, mesh, simplify or improve without writing or printing. The report of the result is in
/// `run.report`.
///
/// \throws Error as run_command()
Prepared make_result(CommandRun& run);

/// Records the error of a failed run and writes its statistics. Does not throw: if they cannot be written
/// either, a line says so.
void report_failure(const std::exception& error, CommandRun& run);

/// Runs `check` without printing; writes the files of `run.line`.
///
/// \throws Error as run_command()
CheckReport make_check(CommandRun& run);

void run_check(CommandRun& run);
/// Runs the jobs of a batch and prints a line when one ends.
void run_batch(CommandRun& run);
void run_sample(CommandRun& run);

}  // namespace tetwright

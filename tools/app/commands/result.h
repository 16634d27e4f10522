// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/app/commands/command_run.h"
#include "tools/app/commands/commands.h"

namespace tetwright {

/// Compares the mesh that a command made with what was asked for and with what was there before: fills
/// `run.report`.
void assess(const TetMesh& mesh, CommandRun& run);

/// Writes all files that `run.line` asks for, or none. Throws OutputError and Interrupted.
void write_result(CommandResult& result, CommandRun& run);

/// Prints the report to stdout, notes and what falls short to stderr.
void print_result(const CommandRun& run);

}  // namespace tetwright

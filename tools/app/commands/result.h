// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/prepare.h"
#include "tools/app/commands/command_run.h"

namespace tetwright {

/// Writes all files that `run.line` asks for, or none. Throws OutputError and Interrupted.
void write_result(Prepared& result, CommandRun& run);

/// Prints the report to stdout, notes and what falls short to stderr.
void print_result(const CommandRun& run);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tetwright/prepare.h"
#include "tools/app/commands/command_run.h"

namespace tetwright {

/// Writes all output files of the run, or none.
///
/// \throws OutputError if one cannot be written
/// \throws Interrupted if the run was cancelled
void write_result(Prepared& result, CommandRun& run);

/// Prints the report to stdout; notes and shortfalls to stderr.
void print_result(const CommandRun& run);

}  // namespace tetwright

#pragma once

#include "tools/command_line.h"
#include "tools/exit_status.h"

namespace tetwright {

/// Carries out the command of `line` and prints its result. Throws Error for everything that ends it early.
ExitStatus run_command(const CommandLine& line);

ExitStatus run_prepare(const CommandLine& line);
ExitStatus run_mesh(const CommandLine& line);
ExitStatus run_simplify(const CommandLine& line);
ExitStatus run_improve(const CommandLine& line);
ExitStatus run_check(const CommandLine& line);
ExitStatus run_sample(const CommandLine& line);

}  // namespace tetwright

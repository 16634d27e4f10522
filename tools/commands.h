#pragma once

#include "common/error.h"
#include "tools/command_line.h"

namespace tetwright {

/// Carries the command out and prints its result. Throws Error for everything that ends it early.
ExitStatus run_command(const CommandLine& line);

}  // namespace tetwright

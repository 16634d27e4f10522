#pragma once

#include <CLI/CLI.hpp>

#include "tools/command_line.h"

namespace tetwright {

/// Adds to a parsed command line which options were given, and what its streams are. `chosen` is the command
/// that parsed it. Throws UsageError for options that do not go together.
void complete_command_line(const CLI::App& chosen, CommandLine& out);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tools/app/command_line.h"

namespace tetwright {

/// Throws UsageError where the mesh would be written in a format without ten-node tets.
void check_holds_second_order(const std::string& output, const std::string& format);

/// Adds to a parsed command line which options were given, and what its streams are. `chosen` is the command
/// that parsed it. Throws UsageError for options that do not go together.
void complete_command_line(const CLI::App& chosen, CommandLine& out);

}  // namespace tetwright

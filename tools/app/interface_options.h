// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "tools/app/command_line.h"

namespace tetwright {

/// Adds --select.
void add_selections(CLI::App& app, CommandLine& c);

/// Adds --split-interface and --cohesive.
void add_interface_options(CLI::App& app, CommandLine& c);

/// Checks that the output can hold what these options request.
///
/// \throws UsageError if it cannot
void check_interface_options(const CommandLine& line);

}  // namespace tetwright

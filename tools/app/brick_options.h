// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "tools/app/command_line.h"

namespace tetwright {

/// Adds --bricks and the options for them.
void add_bricks(CLI::App& app, CommandLine& c);

}  // namespace tetwright

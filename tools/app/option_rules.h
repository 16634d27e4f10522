// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/app/command_line.h"

namespace tetwright {

/// Throws UsageError where the mesh would be written in a format without ten-node tets.
void check_holds_second_order(const std::string& output, const std::string& format);

/// Adds to a parsed command line what its streams are. Throws UsageError for options that do not go together.
void complete_command_line(CommandLine& out);

}  // namespace tetwright

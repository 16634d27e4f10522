// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/app/command_line.h"

namespace tetwright {

/// Checks that the format of the output has ten-node tets.
///
/// \throws UsageError if not
void check_holds_second_order(const std::string& output, const std::string& format);

/// Resolves the streams of a parsed command line and checks its options.
///
/// \throws UsageError if options do not go together, or an input is missing
void complete_command_line(CommandLine& out);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/app/command_line.h"

namespace tetwright {

/// Checks that the format of the output supports tets of ten nodes.
///
/// \throws UsageError if it does not
void check_holds_second_order(const std::string& output, const std::string& format);

/// Resolves the streams of a parsed command line and checks its options.
///
/// \throws UsageError if options cannot be combined, or an input is missing
void complete_command_line(CommandLine& out);

}  // namespace tetwright

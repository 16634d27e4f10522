// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tetwright/prepare.h"
#include "tools/app/command_line.h"

namespace tetwright {

/// Prints the table of the meshes before and after the run to stdout.
/// \param parts of the mesh; null: it is not divided
void print_report(const CommandLine& line, const PrepareReport& run,
                  const PartitionStatistics* parts = nullptr);

/// Prints notes to stderr, each on its own line.
void print_notes(const std::vector<std::string>& notes);

/// Prints "tetwright: TEXT" as one line to stderr and appends it to the log. Control characters, as in file
/// names, become question marks.
void print_line(const std::string& text);

}  // namespace tetwright

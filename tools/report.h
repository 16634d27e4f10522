#pragma once

#include <string>

#include "tools/command_line.h"
#include "tools/run_report.h"

namespace tetwright {

/// Prints the table of the meshes before and after to stdout.
void print_report(const CommandLine& line, const RunReport& run);

/// Prints notes to stderr: one line with what was found in the inputs and what was done about it, one with
/// parts that were too small for the cells, and one for each material that is too thin for them. Prints
/// nothing if there is nothing to report.
void print_notes(const RunReport& run);

/// Prints "tetwright: TEXT" as one line to stderr; control characters, which names may contain, become
/// question marks.
void print_line(const std::string& text);

}  // namespace tetwright

#pragma once

#include <string>
#include <vector>

#include "tools/command_line.h"
#include "tools/run_report.h"

namespace tetwright {

/// Prints the table of the meshes before and after to stdout.
void print_report(const CommandLine& line, const RunReport& run);

/// The notes, a line each: what was found in the inputs and what was done about it, parts that were too small
/// for the cells, and each material that is too thin for them. Empty if there is nothing to report.
std::vector<std::string> notes_of(const RunReport& run);
/// Prints them to stderr.
void print_notes(const std::vector<std::string>& notes);

/// The name of a group, or its number.
std::string patch_name(const FaceGroup& group);

/// Prints "tetwright: TEXT" as one line to stderr, and appends it to the log; control characters, which names
/// may contain, become question marks.
void print_line(const std::string& text);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/types.h"
#include "tools/app/command_line.h"
#include "tools/prepare/run_report.h"

namespace tetwright {

/// Prints the table of the meshes before and after to stdout.
void print_report(const CommandLine& line, const RunReport& run);

/// The notes, a line each: what was found in the inputs and what was done about it, parts that were too small
/// for the cells, and each material that is too thin for them. Empty if there is nothing to report.
std::vector<std::string> notes_of(const RunReport& run);

/// A note, with its place where it is known (input units).
struct RunNote {
  std::string text;
  std::optional<Vec3> place;
};
/// Those of notes_of() behind the first, which lists what was found in the inputs.
std::vector<RunNote> further_notes(const RunReport& run);
/// Prints them to stderr.
void print_notes(const std::vector<std::string>& notes);

/// The name of a group, or its number.
std::string patch_name(const SurfaceRegion& group);

/// Prints "tetwright: TEXT" as one line to stderr, and appends it to the log; control characters, which names
/// may contain, become question marks.
void print_line(const std::string& text);

}  // namespace tetwright

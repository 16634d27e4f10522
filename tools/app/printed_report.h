// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/types.h"
#include "tools/app/command_line.h"
#include "tools/prepare/run_report.h"

namespace tetwright {

/// Prints the table of the meshes before and after to stdout.
void print_report(const CommandLine& line, const RunReport& run);

enum class NotesOf : std::uint8_t { all, certain };
/// The notes, a line each: what was found in the inputs and what was done about it, parts that were too small
/// for the cells, and each material that may have been lost in part. Empty if there is nothing to report.
std::vector<std::string> notes_of(const RunReport& run, NotesOf which = NotesOf::all);

/// A note, with its place where it is known (input units).
struct RunNote {
  std::string text;
  std::optional<Vec3> place;
  bool certain = true;  ///< false: it differs from an estimate, which may be what is wrong; never a status
};
/// Those of notes_of() behind the first, which lists what was found in the inputs.
std::vector<RunNote> further_notes(const RunReport& run);
/// Prints them to stderr.
void print_notes(const std::vector<std::string>& notes);

/// "its surface is open", of any but SurfaceFlaw::none.
const char* flaw_text(SurfaceFlaw flaw);

/// The name of a group, or its number.
std::string patch_name(const SurfaceRegion& group);

/// Prints "tetwright: TEXT" as one line to stderr, and appends it to the log; control characters, which names
/// may contain, become question marks.
void print_line(const std::string& text);

}  // namespace tetwright

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/types.h"
#include "tools/prepare/report.h"

namespace tetwright {

/// The notes, a line each: what was found in the inputs and what was done about it, parts that were too small
/// for the cells, and each material that is too thin for them. Empty if there is nothing to report.
std::vector<std::string> notes_of(const PrepareReport& run);

/// A note, with its place where it is known (input units).
struct RunNote {
  std::string text;
  std::optional<Vec3> place;
};
/// Those of notes_of() behind the first, which lists what was found in the inputs.
std::vector<RunNote> further_notes(const PrepareReport& run);

}  // namespace tetwright

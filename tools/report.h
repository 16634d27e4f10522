#pragma once

#include "tools/stats_json.h"

namespace tetwright {

/// The short table of before and after on stdout.
void print_report(const CommandLine& line, const RunReport& run);

/// On stderr: a line about what was found in the surfaces and done about it, and one for each material that
/// is too thin for the cells. Nothing where there is nothing to say.
void print_notes(const RunReport& run);

}  // namespace tetwright

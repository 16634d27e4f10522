#pragma once

#include "tools/stats_json.h"

namespace tetwright {

/// The short table of before and after on stdout.
void print_report(const CommandLine& line, const RunReport& run);

}  // namespace tetwright

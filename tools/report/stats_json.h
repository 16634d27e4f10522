// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "tools/app/commands/command_run.h"
#include "tools/compare/check_report.h"

namespace tetwright {

/// Peak resident memory of this process so far, bytes.
std::size_t peak_bytes();

/// JSON text of --stats, with the keys of data/stats.schema.json. Bytes that are not UTF-8, which file names
/// may contain, become replacement characters.
std::string stats_json(const CommandRun& run);

/// JSON text of `check --json`, with the statistics of the result.
std::string check_json(const CommandRun& run, const CheckReport& check);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "tools/app/command_line.h"
#include "tools/prepare/run_report.h"

namespace tetwright {

/// The largest resident size of this process so far, bytes.
std::size_t peak_bytes();

/// The JSON text that --stats writes, with the keys of data/stats.schema.json. Bytes that are not UTF-8,
/// which names may contain, become replacement characters.
std::string stats_json(const CommandLine& line, const RunReport& run);

/// The JSON text that `check --json` prints. The statistics are those of run.result.
std::string check_json(const CommandLine& line, const RunReport& run, const CheckReport& check);

}  // namespace tetwright

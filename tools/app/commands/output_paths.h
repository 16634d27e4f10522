// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/app/command_line.h"

namespace tetwright {

/// Checks the files that a command will write, before any work: -o, --boundary, --write-sdf and --report have
/// a known extension, can be written, and replace neither an input nor each other, not even through a link.
/// `check` writes no mesh. Only `simplify` and `improve` may replace their input, by -o. Throws UsageError
/// and OutputError.
void check_output_paths(const CommandLine& line);

/// Throws UsageError for a tet mesh in a format of several files on standard output.
void check_tet_stream(const CommandLine& line);

/// All files that the call writes, and all that it reads, those that belong to one that is named among them.
std::vector<std::string> written_files(const CommandLine& line);
std::vector<std::string> read_files(const CommandLine& line);

/// The file of a batch's results.
std::string results_file_of(const CommandLine& line);

/// The same for --stats and --log-file, which then say how the rest went; opens the log.
void check_stats_path(const CommandLine& line);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/app/command_line.h"

namespace tetwright {

/// Checks the output files of a command before any work: -o, --boundary, --write-sdf and --report have a
/// known extension, can be written, and replace neither an input nor each other, not even through a link.
/// Only `simplify` and `improve` may replace their input, by -o. `check` writes no mesh.
///
/// \throws UsageError for a wrong name
/// \throws OutputError if a file cannot be written
void check_output_paths(const CommandLine& line);

/// Checks that a tet mesh on standard output is of a single file.
///
/// \throws UsageError if its format has several files
void check_tet_stream(const CommandLine& line);

/// All files that the call writes or reads; the files read include those that a named one refers to.
std::vector<std::string> written_files(const CommandLine& line);
std::vector<std::string> read_files(const CommandLine& line);

/// The file of a batch's results.
std::string results_file_of(const CommandLine& line);

/// Checks --stats and --log-file likewise, so that they can report later errors, and opens the log.
void check_stats_path(const CommandLine& line);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/app/command_line.h"

namespace tetwright {

/// Checks the output files of a command before any work. The files of -o, --boundary, --write-sdf and
/// --report must have a known extension and be writable, and must not replace an input or each other, not
/// even through a link. Only `simplify`, `improve` and `values` may replace
/// their input, by -o. `check` writes no mesh.
///
/// \throws UsageError for an invalid name
/// \throws OutputError if a file cannot be written
void check_output_paths(const CommandLine& line);

/// Checks that a tet mesh for standard output is in a format with a single file.
///
/// \throws UsageError if its format has several files
void check_tet_stream(const CommandLine& line);

/// All files that the call writes or reads. The files read include those to which a named file refers.
std::vector<std::string> written_files(const CommandLine& line);
std::vector<std::string> read_files(const CommandLine& line);

/// File with the table of bins, beside the mesh; empty: none is written.
std::string bins_table_of(const CommandLine& line);

/// The table of the pairs of points on parted interfaces, beside the mesh; empty: none.
/// \param parted whether the mesh has parted interfaces
std::string pairs_table_of(const CommandLine& line, bool parted);

/// Path of the file with the results of a batch.
std::string results_file_of(const CommandLine& line);

/// Checks the files of --stats and --log-file in the same way and opens the log, so that later errors can be
/// reported there.
void check_stats_path(const CommandLine& line);

}  // namespace tetwright

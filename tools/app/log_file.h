// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tetwright {

/// Opens the file to which log_line() appends, creating it if it is missing.
///
/// \throws OutputError if it cannot be written
void open_log(const std::string& path);

/// Appends a line with the UTC date and time, and flushes it; does nothing before open_log(). Control
/// characters become question marks. Thread-safe.
void log_line(const std::string& text);

}  // namespace tetwright

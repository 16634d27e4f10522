// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tetwright {

/// From now on log_line() appends to the file, which is made if it isn't there. Throws OutputError if it
/// cannot be written.
void open_log(const std::string& path);

/// Appends a line with the date and time in UTC and writes it out at once; does nothing before open_log().
/// Control characters become question marks. Any thread may call it.
void log_line(const std::string& text);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>

namespace tetwright {

/// The exit statuses of the program.
enum class ExitStatus : int {
  done = 0,
  short_of_request = 1,  ///< written, but a request was not met; `check`: not valid
  usage = 2,
  bad_input = 3,
  nothing_to_mesh = 4,
  output_failed = 5,    ///< output could not be written, or memory or time ran out
  internal_error = 70,  ///< a broken invariant, which is a bug here (EX_SOFTWARE of sysexits.h)
  interrupted = 130
};

/// The status with which the program ends when `error` reaches main(), and what it says then.
ExitStatus exit_status(const std::exception& error);
std::string failure_message(const std::exception& error);

/// What follows a message about a bug here.
inline constexpr const char* report_this =
    "; this is a bug in tetwright: please report it with this line, the version, the command and its input";

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>

#include "tetwright/diagnostic.h"

namespace tetwright {

/// Exit statuses of the program.
enum class ExitStatus : int {
  done = 0,
  short_of_request = 1,  ///< written, but a request was not met; for `check`: not valid
  usage = 2,
  bad_input = 3,
  nothing_to_mesh = 4,
  output_failed = 5,    ///< output could not be written, or memory or time was exhausted
  internal_error = 70,  ///< broken invariant, a bug in tetwright (EX_SOFTWARE of sysexits.h)
  interrupted = 130
};

/// Exit status and message of the program for an `error` that reaches main().
ExitStatus exit_status(const std::exception& error);
std::string failure_message(const std::exception& error);

/// Diagnostic code of errors with this status.
DiagnosticCode error_code(ExitStatus status);

/// Last part of the message for an internal error.
inline constexpr const char* report_this =
    "; this is a bug in tetwright: please report it with this line, the version, the command and its input";

}  // namespace tetwright

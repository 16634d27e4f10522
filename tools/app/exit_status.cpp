// SPDX-License-Identifier: Apache-2.0
#include "tools/app/exit_status.h"

#include <new>
#include <stdexcept>
#include <system_error>
#include <typeinfo>

#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Whether the error means that no thread could be started; oneTBB throws a plain std::runtime_error.
bool no_thread(const std::exception& error) {
  return dynamic_cast<const std::system_error*>(&error) || typeid(error) == typeid(std::runtime_error);
}

}  // namespace

ExitStatus exit_status(const std::exception& error) {
  if (dynamic_cast<const UsageError*>(&error)) return ExitStatus::usage;
  if (dynamic_cast<const NothingToMeshError*>(&error)) return ExitStatus::nothing_to_mesh;
  if (dynamic_cast<const OutputError*>(&error) || dynamic_cast<const OutOfTime*>(&error) ||
      dynamic_cast<const std::bad_alloc*>(&error) || no_thread(error))
    return ExitStatus::output_failed;
  if (dynamic_cast<const Interrupted*>(&error)) return ExitStatus::interrupted;
  if (dynamic_cast<const std::logic_error*>(&error)) return ExitStatus::internal_error;
  return ExitStatus::bad_input;
}

DiagnosticCode error_code(ExitStatus status) {
  switch (status) {
    case ExitStatus::usage:
      return DiagnosticCode::usage;
    case ExitStatus::bad_input:
      return DiagnosticCode::input;
    case ExitStatus::nothing_to_mesh:
      return DiagnosticCode::nothing_to_mesh;
    case ExitStatus::output_failed:
      return DiagnosticCode::output;
    case ExitStatus::interrupted:
      return DiagnosticCode::interrupted;
    default:
      return DiagnosticCode::internal;
  }
}

std::string failure_message(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error))
    return "not enough memory; free some, or ask for less (for surfaces: a smaller --resolution)";
  if (no_thread(error))
    return std::string(error.what()) + "; out of memory or threads: free some, or give fewer --threads";
  return std::string(error.what()) + (dynamic_cast<const std::logic_error*>(&error) ? report_this : "");
}

}  // namespace tetwright

#include "tools/exit_status.h"

#include <new>

#include "common/error.h"

namespace tetwright {

ExitStatus exit_status(const std::exception& error) {
  if (dynamic_cast<const UsageError*>(&error)) return ExitStatus::usage;
  if (dynamic_cast<const NothingToMeshError*>(&error)) return ExitStatus::nothing_to_mesh;
  if (dynamic_cast<const OutputError*>(&error) || dynamic_cast<const OutOfTime*>(&error) ||
      dynamic_cast<const std::bad_alloc*>(&error))
    return ExitStatus::output_failed;
  if (dynamic_cast<const Interrupted*>(&error)) return ExitStatus::interrupted;
  if (dynamic_cast<const InternalError*>(&error)) return ExitStatus::internal_error;
  return ExitStatus::bad_input;
}

std::string failure_message(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error))
    return "not enough memory; free some, or ask for less (of surfaces: a smaller --resolution)";
  return std::string(error.what()) + (dynamic_cast<const InternalError*>(&error) ? report_this : "");
}

}  // namespace tetwright

#pragma once

#include "mesher/mesher.h"
#include "tools/commands/command_run.h"
#include "tools/exit_status.h"

namespace tetwright {

/// The last step of every command that makes a mesh: compares the result with what was asked for and with
/// what was there before, writes all output files, and prints the report. `field` is written to --write-sdf
/// unless it is null. Returns short_of_request if a request was not met. Throws OutputError and Interrupted;
/// then no file is written.
ExitStatus finish(const TetMesh& mesh, const MaterialField* field, CommandRun& run);

}  // namespace tetwright

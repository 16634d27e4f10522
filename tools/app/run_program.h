// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tetwright {

class ProcessTeam;

/// Runs the command of the arguments and returns the program's exit status. Errors are printed. Sets
/// handlers of signals and of std::terminate.
/// \param team processes that make bricks and write files together, each of which calls this with the same
/// arguments; null:
///   this one alone
int run_program(int argc, char** argv, ProcessTeam* team = nullptr);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tetwright {

/// After this call SIGHUP, SIGINT and SIGTERM end the process immediately with status 130 and one line on
/// stderr that says whether the output was written. Files that are being written are removed; existing files
/// stay as they were. A signal that arrives while the finished files are renamed takes effect once all of
/// them are in place.
///
/// The stack is not unwound, so that nothing has to poll for signals, and waiting for a pipe ends as well. A
/// SIGHUP that the parent process ignores stays ignored, as nohup requires.
///
/// Call it first in main(), before there are threads.
void handle_interruptions();

/// What is said instead when the process ends in this way; a string literal.
void say_when_interrupted(const char* line);

}  // namespace tetwright

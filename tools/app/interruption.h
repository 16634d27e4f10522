// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tetwright {

/// Makes SIGHUP, SIGINT and SIGTERM end the process immediately with status 130 and one line on stderr that
/// tells whether the output was written. Unfinished files are removed; existing files are kept. A signal that
/// arrives while finished files are renamed takes effect once all are renamed.
///
/// The stack is not unwound: no code has to poll for signals, and waiting for a pipe is interrupted too. A
/// SIGHUP that the parent process ignores stays ignored, as nohup requires.
///
/// \pre Called first in main(), before threads start.
void handle_interruptions();

/// Replaces the line printed on interruption. `line` must be a string literal.
void say_when_interrupted(const char* line);

/// Says nothing when interrupted if this file is missing: another process of this job has then removed it,
/// told the user why, and ended this process. A name of more than 4,000 bytes has no effect. Not safe for
/// concurrent use.
/// \param path empty: no such file
void say_nothing_without(const std::string& path);

}  // namespace tetwright

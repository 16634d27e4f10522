// SPDX-License-Identifier: Apache-2.0
#include "tools/app/interruption.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

#include "tetwright/files.h"
#include "tools/app/exit_status.h"

namespace tetwright {

namespace {

constexpr std::array<int, 3> ending_signals{SIGHUP, SIGINT, SIGTERM};

/// Determined in advance, since isatty() need not be async-signal-safe.
bool stderr_is_terminal = false;

std::atomic<const char*> line_to_say{nullptr};

void say(const char* text) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text));
}

/// Async-signal-safe.
void end_at_once(int) {
  const bool output_is_there = abandon_output_files();
  if (stderr_is_terminal) say("\r\x1b[K");  // erases a progress bar
  if (const char* line = line_to_say)
    say(line);
  else if (output_is_there)
    say("tetwright: interrupted after the output was written\n");
  else
    say("tetwright: interrupted, nothing was written\n");
  _exit(static_cast<int>(ExitStatus::interrupted));
}

}  // namespace

void say_when_interrupted(const char* line) { line_to_say = line; }

void handle_interruptions() {
  struct sigaction action {};
  action.sa_handler = end_at_once;
  sigset_t ending;
  sigemptyset(&ending);
  for (const int signal : ending_signals) sigaddset(&ending, signal);
  action.sa_mask = ending;  // a second signal must not interrupt the handler of the first
  for (const int signal : ending_signals) {
    struct sigaction before {};
    if (signal == SIGHUP && sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN)
      continue;
    sigaction(signal, &action, nullptr);
  }
  // The parent process may have blocked these signals.
  sigprocmask(SIG_UNBLOCK, &ending, nullptr);
  stderr_is_terminal = isatty(STDERR_FILENO) != 0;
}

}  // namespace tetwright

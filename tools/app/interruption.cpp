// SPDX-License-Identifier: Apache-2.0
#include "tools/app/interruption.h"

#include <unistd.h>

#include <algorithm>
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

/// The file of say_nothing_without(), whose name is complete while `watched` is true.
std::array<char, 4001> watched_file;
std::atomic<bool> watched = false;

void say(const char* text) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text));
}

/// Async-signal-safe.
void end_at_once(int) {
  const bool told_by_another = watched && access(watched_file.data(), F_OK) != 0;
  const bool output_is_there = abandon_output_files();
  if (stderr_is_terminal) say("\r\x1b[K");  // erases a progress bar
  const char* line = line_to_say;
  if (!line)
    line = output_is_there ? "tetwright: interrupted after the output was written\n"
                           : "tetwright: interrupted, nothing was written\n";
  if (!told_by_another) say(line);
  _exit(static_cast<int>(ExitStatus::interrupted));
}

}  // namespace

void say_when_interrupted(const char* line) { line_to_say = line; }

void say_nothing_without(const std::string& path) {
  watched = false;
  if (path.empty() || path.size() >= watched_file.size()) return;
  std::copy_n(path.c_str(), path.size() + 1, watched_file.begin());
  watched = true;
}

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

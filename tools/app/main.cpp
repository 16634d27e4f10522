// SPDX-License-Identifier: Apache-2.0

// The tetwright program: runs one command and returns its exit status.
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "tetwright/files.h"
#include "tools/app/command_line.h"
#include "tools/app/commands/commands.h"
#include "tools/app/exit_status.h"
#include "tools/app/interruption.h"
#include "tools/app/log_file.h"
#include "tools/app/printed_report.h"

int main(int argc, char** argv) {
  tetwright::handle_interruptions();
  using tetwright::ExitStatus;
#ifdef __GLIBC__
  // Return large blocks to the system when they are freed. By default glibc raises the threshold to the size
  // of freed blocks and then keeps later blocks in its heaps, which would be gigabytes between stages.
  // Setting the threshold, here to its initial value, keeps it constant. glibc still uses its heaps while
  // more than 65,536 large blocks are allocated.
  mallopt(M_MMAP_THRESHOLD, 128 << 10);
#endif
  // A full disk or a closed pipe must lead to an error message, not to a signal.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  // For exceptions that the handlers below cannot catch. Nearly always the system could not start a thread,
  // which oneTBB reports as a std::runtime_error.
  std::set_terminate([] {
    (void)tetwright::abandon_output_files();
    try {
      if (const std::exception_ptr current = std::current_exception()) std::rethrow_exception(current);
    } catch (const std::logic_error& e) {
      tetwright::print_line(std::string(e.what()) + tetwright::report_this);
      _exit(static_cast<int>(ExitStatus::internal_error));
    } catch (...) {
    }
    constexpr char message[] = "tetwright: out of memory or threads; give fewer --threads\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, message, sizeof message - 1);
    _exit(static_cast<int>(ExitStatus::output_failed));
  });
  const auto fail = [](ExitStatus status, const std::string& message) {
    tetwright::print_line(message);
    tetwright::log_line("exit status " + std::to_string(static_cast<int>(status)));
    return static_cast<int>(status);
  };
  try {
    tetwright::CommandLine line;
    if (!tetwright::parse_command_line(argc, argv, line)) return 0;
    const ExitStatus status = tetwright::run_command(line);
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
      return fail(ExitStatus::output_failed,
                  "cannot write to standard output" + (line.outputs.mesh.empty() || line.outputs.mesh == "-"
                                                           ? ""
                                                           : "; " + line.outputs.mesh + " is written"));
    tetwright::log_line("exit status " + std::to_string(static_cast<int>(status)));
    return static_cast<int>(status);
  } catch (const std::exception& e) {
    return fail(tetwright::exit_status(e), tetwright::failure_message(e));
  }
}

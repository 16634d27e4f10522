// SPDX-License-Identifier: Apache-2.0

#include "tools/app/run_program.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "tetwright/error.h"
#include "tetwright/file_sharing.h"
#include "tetwright/files.h"
#include "tetwright/prepare_steps.h"
#include "tetwright/resources.h"
#include "tools/app/command_line.h"
#include "tools/app/commands/commands.h"
#include "tools/app/exit_status.h"
#include "tools/app/interruption.h"
#include "tools/app/log_file.h"
#include "tools/app/printed_report.h"
#include "tools/bricks/process_team.h"

namespace tetwright {

namespace {

/// Prepares the command for a member of a team. Only the leader writes and prints.
void join(ProcessTeam& team, CommandLine& line) {
  BrickOptions& bricks = line.options.bricks;
  if (line.command != Command::prepare || bricks.use == BrickOptions::Use::never)
    throw UsageError(
        "tetwright-mpi makes bricks of segmented volumes: use it with 'prepare' and without "
        "--bricks off, or use tetwright");
  if (std::find(line.inputs.begin(), line.inputs.end(), standard_input) != line.inputs.end())
    throw UsageError("tetwright-mpi cannot read standard input, which only rank 0 has; give a file");
  if (const char* const other = conflict_with_bricks(line.options))
    throw UsageError(std::string("tetwright-mpi makes bricks, which do not work with ") + other +
                     "; leave it out, or use tetwright");
  if (bricks.use == BrickOptions::Use::automatic) {
    bricks.use = BrickOptions::Use::always;
    bricks.cells = default_brick_cells;
  }
  bricks.team = &team;
  if (team.is_leader()) return;
  line.console = {};
  line.console.quiet = true;
  line.console.progress = ProgressStyle::none;
  line.outputs.stats.clear();
}

/// Writes pieces of the mesh until the leader has written everything.
void help_to_write(ProcessTeam& team, const CommandLine& line) {
  with_threads(line.options.limits.threads, [&] {
    team.help([](const std::string& order) {
      write_ordered_piece(order);
      return std::string();
    });
  });
}

}  // namespace

int run_program(int argc, char** argv, ProcessTeam* team) {
  // A signal that ends a helper ends the leader, too, which tells the user.
  if (!team || team->is_leader()) handle_interruptions();
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
    (void)abandon_output_files();
    try {
      if (const std::exception_ptr current = std::current_exception()) std::rethrow_exception(current);
    } catch (const std::logic_error& e) {
      print_line(std::string(e.what()) + report_this);
      _exit(static_cast<int>(ExitStatus::internal_error));
    } catch (...) {
    }
    constexpr char message[] = "tetwright: out of memory or threads; give fewer --threads\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, message, sizeof message - 1);
    _exit(static_cast<int>(ExitStatus::output_failed));
  });
  const auto fail = [](ExitStatus status, const std::string& message) {
    print_line(message);
    log_line("exit status " + std::to_string(static_cast<int>(status)));
    return static_cast<int>(status);
  };
  try {
    CommandLine line;
    if (!parse_command_line(argc, argv, line)) return 0;
    if (team) join(*team, line);
    line.options.bricks.when_kept = [] {
      say_when_interrupted(
          "tetwright: interrupted; the same call goes on from the bricks that are finished\n");
    };
    ExitStatus status = ExitStatus::done;
    try {
      status = run_command(line);
    } catch (const HelperFinished&) {
      help_to_write(*team, line);
      return 0;
    }
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
      return fail(ExitStatus::output_failed,
                  "cannot write to standard output" + (line.outputs.mesh.empty() || line.outputs.mesh == "-"
                                                           ? ""
                                                           : "; " + line.outputs.mesh + " is written"));
    log_line("exit status " + std::to_string(static_cast<int>(status)));
    return static_cast<int>(status);
  } catch (const std::exception& e) {
    if (team && !team->is_leader()) {
      team->report(static_cast<int>(exit_status(e)), failure_message(e));
      return static_cast<int>(exit_status(e));
    }
    return fail(exit_status(e), failure_message(e));
  }
}

}  // namespace tetwright

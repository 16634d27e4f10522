// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/commands.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>

#include "common/error.h"
#include "common/message_text.h"
#include "common/parallel/parallel.h"
#include "tools/app/commands/output_paths.h"
#include "tools/app/commands/result.h"
#include "tools/app/printed_report.h"
#include "tools/app/progress_report.h"
#include "tools/report/stats_json.h"

namespace tetwright {

namespace {

/// More than any machine has, and what fits into 64 bits.
constexpr double max_gigabytes = 1e9;

void run_meshing(CommandRun& run) {
  check_output_paths(run.line);
  CommandResult result = make_result(run);
  write_result(result, run);
  print_result(run);
}

/// What estimates do not see ends as memory that runs out.
void limit_process_memory(const CommandLine& line) {
  // The system counts what is reserved, too: the stacks of threads, and what their heaps may grow into.
  constexpr double reserved = 64 << 20, reserved_by_thread = 16 << 20;
  rlimit limit;
  if (line.memory_limit == 0 || getrlimit(RLIMIT_DATA, &limit) != 0) return;
  const double bytes = std::min(line.memory_limit, max_gigabytes) * (1 << 30) + reserved +
                       reserved_by_thread * (line.threads > 0 ? line.threads : thread_count());
  limit.rlim_cur = static_cast<rlim_t>(std::min(static_cast<double>(limit.rlim_max), bytes));
  setrlimit(RLIMIT_DATA, &limit);
}

}  // namespace

CommandResult make_result(CommandRun& run) {
  CommandResult result;
  try {
    result = run.line.command == Command::prepare    ? run_prepare(run)
             : run.line.command == Command::mesh     ? run_mesh(run)
             : run.line.command == Command::simplify ? run_simplify(run)
                                                     : run_improve(run);
  } catch (const OutOfTime&) {
    const bool cells = run.line.command == Command::prepare || run.line.command == Command::mesh;
    throw OutOfTime("out of time: after the " + short_number(run.line.time_limit) +
                    " s of --time-limit there was no mesh yet (in stage '" + run.progress.stage() +
                    "'), and nothing was written; give more time" +
                    (cells ? ", or larger cells by --resolution" : ""));
  }
  // What there is, is compared and written.
  run.progress.set_deadline(Progress::no_deadline);
  assess(result.mesh, run);
  return result;
}

void report_failure(const std::exception& error, CommandRun& run) {
  run.report.status = exit_status(error);
  run.report.error = error.what();
  run.report.stage = run.progress.stage();
  run.report.seconds_total = run.since_start.seconds();
  try {
    OutputFiles files;
    write_stats(run, files);
    files.commit();
    if (run.line.stats == "-") std::printf("%s\n", stats_json(run.line, run.report).c_str());
  } catch (const std::exception& of_stats) {
    run.progress.finish();
    print_line(of_stats.what());
  }
}

ExitStatus run_command(const CommandLine& line) {
  check_stats_path(line);
  ProgressReport progress(progress_style(line));
  CommandRun run(line, progress);
  limit_process_memory(line);
  try {
    with_threads(line.threads, [&] {
      if (line.command == Command::check)
        run_check(run);
      else if (line.command == Command::batch)
        run_batch(run);
      else if (line.command == Command::sample)
        run_sample(run);
      else
        run_meshing(run);
    });
  } catch (const std::exception& e) {
    report_failure(e, run);
    throw;
  }
  return run.report.status;
}

}  // namespace tetwright

#include "tools/commands/commands.h"

#include <cstdio>

#include "common/parallel/parallel.h"
#include "tools/commands/output_paths.h"
#include "tools/commands/result.h"
#include "tools/progress_report.h"
#include "tools/report.h"
#include "tools/stats_json.h"

namespace tetwright {

namespace {

void run_meshing(CommandRun& run) {
  check_output_paths(run.line);
  CommandResult result = make_result(run);
  write_result(result, run);
  print_result(run);
}

/// The statistics of a run that failed. That they cannot be written either is said, and the run's own error
/// matters more.
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

}  // namespace

CommandResult make_result(CommandRun& run) {
  CommandResult result = run.line.command == Command::prepare    ? run_prepare(run)
                         : run.line.command == Command::mesh     ? run_mesh(run)
                         : run.line.command == Command::simplify ? run_simplify(run)
                                                                 : run_improve(run);
  assess(result.mesh, run);
  return result;
}

ExitStatus run_command(const CommandLine& line) {
  check_stats_path(line);
  ProgressReport progress(progress_style(line));
  CommandRun run(line, progress);
  try {
    with_threads(line.threads, [&] {
      if (line.command == Command::check)
        run_check(run);
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

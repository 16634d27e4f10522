#include "tools/commands/commands.h"

#include <unistd.h>

#include "common/parallel/parallel.h"
#include "tools/commands/output_paths.h"
#include "tools/commands/result.h"
#include "tools/progress_bar.h"

namespace tetwright {

namespace {

ExitStatus run_meshing(const CommandLine& line, Progress& progress) {
  CommandRun run(line, progress);
  check_output_paths(line);
  CommandResult result = make_result(run);
  write_result(result, run);
  print_result(run);
  return run.report.shortfall.empty() ? ExitStatus::done : ExitStatus::short_of_request;
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
  ProgressBar progress(!line.quiet && !line.no_progress && isatty(STDERR_FILENO));
  ExitStatus status = ExitStatus::done;
  with_threads(line.threads, [&] {
    status = line.command == Command::check    ? run_check(line, progress)
             : line.command == Command::sample ? run_sample(line, progress)
                                               : run_meshing(line, progress);
  });
  return status;
}

}  // namespace tetwright

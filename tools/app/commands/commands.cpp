// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/commands.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>

#include "tetwright/error.h"
#include "tetwright/prepare_steps.h"
#include "tetwright/resources.h"
#include "tools/app/commands/output_paths.h"
#include "tools/app/commands/report_file.h"
#include "tools/app/commands/result.h"
#include "tools/app/commands/unwritten.h"
#include "tools/app/printed_report.h"
#include "tools/app/progress_report.h"
#include "tools/report/stats_json.h"

namespace tetwright {

namespace {

/// More memory than any machine has; as a number of bytes it fits into 64 bits.
constexpr double max_gigabytes = 1e9;

void run_meshing(CommandRun& run) {
  check_output_paths(run.line);
  Prepared result = make_result(run);
  write_result(result, run);
  print_result(run);
}

/// Makes allocations fail at the memory limit, in case the estimates are too low.
void limit_process_memory(const CommandLine& line) {
  // The system also counts reserved memory: thread stacks and space for the heaps of threads.
  constexpr double reserved = 64 << 20, reserved_by_thread = 16 << 20;
  rlimit limit;
  if (!line.options.limits.memory || getrlimit(RLIMIT_DATA, &limit) != 0) return;
  const double bytes =
      std::min(*line.options.limits.memory, max_gigabytes) * gigabyte + reserved +
      reserved_by_thread * (line.options.limits.threads > 0 ? line.options.limits.threads : thread_count());
  limit.rlim_cur = static_cast<rlim_t>(std::min(static_cast<double>(limit.rlim_max), bytes));
  setrlimit(RLIMIT_DATA, &limit);
}

}  // namespace

Prepared make_result(CommandRun& run) {
  const CommandLine& line = run.line;
  PrepareOptions options = line.options;
  if (run.in_memory) {
    take_sizes(*run.in_memory, options.sizes);
    take_images(*run.in_memory, options.values);
  }
  options.keep.reference = !line.outputs.report.empty();
  options.keep.field = !line.outputs.distances.empty();
  // Measured: the text of the file is in memory in addition to the mesh.
  constexpr double text_bytes = 130;
  constexpr double parts_bytes = 180;    // measured: faces of all tets, their graph and a piece
  constexpr double message_bytes = 150;  // a piece for another member of a team, and its bytes
  if (line.outputs.parts > 0)
    options.limits.later_bytes_per_tet =
        parts_bytes + (options.bricks.team ? message_bytes / line.outputs.parts : 0);
  else if (!line.outputs.mesh.ends_with(".vtu"))
    options.limits.later_bytes_per_tet = text_bytes;
  PrepareRun preparing(task_of(line.command), options, run.progress, run.report);
  Prepared result = carry_out(inputs_of(line, run.in_memory), preparing);
  if (!line.outputs.mesh.empty()) find_unwritten(line, result.mesh, run.report);
  decide_severities(options.acceptance, run.report);
  run.status = run.report.falls_short() ? ExitStatus::short_of_request : ExitStatus::done;
  if (result.reference) measure_distances(result.mesh, *result.reference, result.reference_name, run);
  result.reference.reset();  // frees memory for writing the mesh
  return result;
}

void report_failure(const std::exception& error, CommandRun& run) {
  run.status = exit_status(error);
  run.error = error.what();
  run.stage = run.progress.stage();
  run.report.seconds_total = run.since_start.seconds();
  run.report.loops_total = run.since_start.loops();
  try {
    OutputFiles files;
    write_stats(run, files);
    files.commit();
    if (run.line.outputs.stats == "-") std::printf("%s\n", stats_json(run).c_str());
  } catch (const std::exception& of_stats) {
    run.progress.finish();
    print_line(of_stats.what());
  }
}

ExitStatus run_command(const CommandLine& line) {
  check_stats_path(line);
  ProgressReport progress(progress_style(line), line.console.quiet);
  CommandRun run(line, progress);
  limit_process_memory(line);
  try {
    with_threads(line.options.limits.threads, [&] {
      if (line.command == Command::check)
        run_check(run);
      else if (line.command == Command::embed)
        run_embed(run);
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
  return run.status;
}

}  // namespace tetwright
